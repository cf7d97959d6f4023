// Writes binary STL: 80 bytes of text, a count, and 50 bytes for each triangle.
#include <limits>

#include "geometry/io/mesh_writers_internal.h"
#include "geometry/mesh_normals.h"

namespace astrolith {
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
