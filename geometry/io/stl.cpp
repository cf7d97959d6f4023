// STL, ascii and binary. The format has no shared vertices: corners at equal coordinates become one vertex,
// and facets that name a vertex twice afterwards are dropped.
#include <limits>

#include "geometry/io/byte_reader_internal.h"
#include "geometry/io/format_internal.h"
#include "geometry/io/text_scanner_internal.h"
#include "geometry/mesh_normals.h"
#include "geometry/weld.h"

namespace astrolith {
namespace {

void add_corner_triangle(TriangleMesh& mesh) {
  const auto n = static_cast<std::uint32_t>(mesh.vertices.size());
  mesh.triangles.push_back({n - 3, n - 2, n - 1});
}

TriangleMesh share_vertices(TriangleMesh mesh) {
  mesh = weld_vertices(std::move(mesh), 0.0);
  std::erase_if(mesh.triangles,
                [](const Triangle& t) { return t[0] == t[1] || t[1] == t[2] || t[2] == t[0]; });
  return mesh;
}

}  // namespace

TriangleMesh read_stl_ascii(const MeshFile& file) {
  TriangleMesh mesh;
  TextScanner scan(file);
  std::size_t corners = 0;
  bool complete = false;
  while (scan.next_line()) {
    const std::string_view word = scan.word();
    if (word == "vertex") {
      mesh.vertices.push_back(scan.point());
      ++corners;
    } else if (word == "endloop") {
      if (corners != 3) scan.fail("the facet has " + std::to_string(corners) + " vertices", "give it three");
      add_corner_triangle(mesh);
      corners = 0;
    }
    if (!word.empty()) complete = word == "endsolid";
  }
  if (!complete) scan.fail_truncated("'endsolid'");
  return share_vertices(std::move(mesh));
}

TriangleMesh read_stl_binary(const MeshFile& file) {
  TriangleMesh mesh;
  ByteReader bytes(file);
  bytes.skip(80, "the header");
  const auto count = bytes.read<std::uint32_t>("the number of triangles");
  bytes.need_rows(count, 50, "triangles");
  if (count > 0xffffffffu / 3) bytes.fail("more corners than 2^32", "write it as .ply");
  mesh.vertices.reserve(std::size_t{3} * count);
  mesh.triangles.reserve(count);
  for (std::uint32_t i = 0; i < count; ++i) {
    bytes.skip(12, "a normal");
    for (int corner = 0; corner < 3; ++corner) {
      mesh.vertices.push_back(bytes.read_floats_xyz());
    }
    bytes.skip(2, "an attribute");
    add_corner_triangle(mesh);
  }
  return share_vertices(std::move(mesh));
}

void write_stl(const TriangleMesh& mesh, const std::filesystem::path& file, const MeshFileInfo& info) {
  if (mesh.triangles.size() > std::numeric_limits<std::uint32_t>::max()) {
    throw WorkError(file.string() + ": STL holds at most 2^32 - 1 triangles; write a .ply");
  }
  // The text must not start with "solid": readers would take the file for the ascii form.
  std::string header = "Binary STL";
  for (const std::string& line : info_lines(info)) header += "; " + line;
  header.resize(80, ' ');
  OutputFile out(file);
  BufferedOutput buffer(out);
  buffer.append(header);
  buffer.append_value(static_cast<std::uint32_t>(mesh.triangles.size()));
  for (const Triangle& t : mesh.triangles) {
    buffer.append_value(to_float(triangle_normal(mesh, t)));
    for (const std::uint32_t index : t) buffer.append_value(to_float(mesh.vertices[index]));
    buffer.append_value(std::uint16_t{0});
  }
  buffer.flush();
  out.commit();
}

}  // namespace astrolith
