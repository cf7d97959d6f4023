// Writes Wavefront OBJ. Coordinates are the shortest decimals that read back as the same doubles.
#include <charconv>

#include "geometry/io/mesh_writers_internal.h"

namespace astrolith {
namespace {

template <typename T>
void append_number(std::string& line, T value) {
  char digits[32];
  line.append(digits, std::to_chars(digits, digits + sizeof digits, value).ptr);
}

void append_vector(std::string& line, std::string_view keyword, const Vec3d& v) {
  line.append(keyword);
  for (const double coordinate : {v.x, v.y, v.z}) {
    line += ' ';
    append_number(line, coordinate);
  }
  line += '\n';
}

void append_face(std::string& line, const Triangle& triangle, bool with_normals) {
  line += 'f';
  for (const std::uint32_t index : triangle) {
    line += ' ';
    append_number(line, std::uint64_t{index} + 1);
    if (!with_normals) continue;
    line += "//";
    append_number(line, std::uint64_t{index} + 1);
  }
  line += '\n';
}

}  // namespace

void write_obj(const TriangleMesh& mesh, const std::filesystem::path& file, const MeshFileInfo& info) {
  OutputFile out(file);
  BufferedOutput buffer(out);
  for (const std::string& text : info_lines(info)) buffer.append("# " + text + "\n");
  buffer.append("# axes: z up; import into Blender with forward axis Y, up axis Z\n");
  std::string line;
  const auto put = [&] {
    buffer.append(line);
    line.clear();
  };
  for (const Vec3d& v : mesh.vertices) append_vector(line, "v", v), put();
  for (const Vec3d& n : mesh.normals) append_vector(line, "vn", n), put();
  for (const Triangle& t : mesh.triangles) append_face(line, t, !mesh.normals.empty()), put();
  buffer.flush();
  out.commit();
}

}  // namespace astrolith
