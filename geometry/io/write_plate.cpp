// Writes plate models of the Planetary Data System: the number of vertices, rows "i x y z", the number of
// plates, rows "i a b c". Both are numbered from 1. Coordinates are the shortest decimals that read back as
// the same doubles.
#include <charconv>

#include "geometry/io/mesh_writers_internal.h"

namespace astrolith {
namespace {

template <typename T>
void append_word(std::string& line, T value) {
  char digits[32];
  line.append(digits, std::to_chars(digits, digits + sizeof digits, value).ptr);
}

}  // namespace

void write_plate(const TriangleMesh& mesh, const std::filesystem::path& file, const MeshFileInfo&) {
  OutputFile out(file);
  BufferedOutput buffer(out);
  const auto row = [&](std::size_t i, const auto& a, const auto& b, const auto& c) {
    std::string line;
    append_word(line, i + 1);
    line += ' ', append_word(line, a);
    line += ' ', append_word(line, b);
    line += ' ', append_word(line, c);
    buffer.append(line + "\n");
  };
  buffer.append(std::to_string(mesh.vertices.size()) + "\n");
  for (std::size_t i = 0; i < mesh.vertices.size(); ++i) {
    const Vec3d& p = mesh.vertices[i];
    row(i, p.x, p.y, p.z);
  }
  buffer.append(std::to_string(mesh.triangles.size()) + "\n");
  for (std::size_t i = 0; i < mesh.triangles.size(); ++i) {
    const auto& [a, b, c] = mesh.triangles[i];
    row(i, std::uint64_t{a} + 1, std::uint64_t{b} + 1, std::uint64_t{c} + 1);
  }
  buffer.flush();
  out.commit();
}

}  // namespace astrolith
