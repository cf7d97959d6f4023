#include "geometry/io/ply_values.h"

#include <array>

#include "geometry/io/format_internal.h"
#include "geometry/io/ply_header_internal.h"

namespace astrolith {
namespace {

std::string header_with(std::string header, std::span<const VertexValues> quantities) {
  std::string properties;
  for (const VertexValues& q : quantities) properties += "property float " + q.name + "\n";
  return header.insert(header.find("element face "), properties);
}

}  // namespace

void write_ply_values(const TriangleMesh& mesh, std::span<const VertexValues> quantities,
                      const std::filesystem::path& file, const MeshFileInfo& info) {
  for (const VertexValues& q : quantities) {
    if (q.values.size() != mesh.vertices.size())
      throw WorkError(file.string() + ": " + q.name + " does not have one value for each vertex");
  }
  OutputFile out(file);
  BufferedOutput buffer(out);
  const bool with_normals = !mesh.normals.empty(), with_colors = !mesh.colors.empty();
  buffer.append(header_with(
      ply_header(info, mesh.vertices.size(), mesh.triangles.size(), {with_normals, with_colors, false}),
      quantities));
  for (std::size_t i = 0; i < mesh.vertices.size(); ++i) {
    buffer.append_value(to_float(mesh.vertices[i]));
    if (with_normals) buffer.append_value(to_float(mesh.normals[i]));
    if (with_colors) buffer.append_value(mesh.colors[i]);
    for (const VertexValues& q : quantities) buffer.append_value(static_cast<float>(q.values[i]));
  }
  for (const Triangle& triangle : mesh.triangles) {
    std::array<char, kPlyTriangleBytes> bytes;
    put_ply_triangle(triangle, bytes.data());
    buffer.append({bytes.data(), bytes.size()});
  }
  buffer.flush();
  out.commit();
}

}  // namespace astrolith
