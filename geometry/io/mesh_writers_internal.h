// One writer for each format, and what the writers share.
#pragma once

#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

#include "geometry/io/mesh_io.h"
#include "numerics/files/output_file.h"

namespace astrolith {

// Writers rely on what write_mesh has checked: at least one triangle, indices in range, and coordinates that
// float32 can hold.
void write_ply(const TriangleMesh& mesh, const std::filesystem::path& file, const MeshFileInfo& info);
void write_obj(const TriangleMesh& mesh, const std::filesystem::path& file, const MeshFileInfo& info);
void write_stl(const TriangleMesh& mesh, const std::filesystem::path& file, const MeshFileInfo& info);
void write_glb(const TriangleMesh& mesh, const std::filesystem::path& file, const MeshFileInfo& info);
// The two formats of plates have no place for comments. write_icq throws InputError for a body that has
// several surfaces along a direction from its centre of mass.
void write_icq(const TriangleMesh& mesh, const std::filesystem::path& file, const MeshFileInfo& info);
// The vertices and triangles of the .icq of a mesh of so many triangles.
MeshCounts icq_counts(std::int64_t triangles);
void write_plate(const TriangleMesh& mesh, const std::filesystem::path& file, const MeshFileInfo& info);

// The lines of a file's comment: "length unit: km", "frame: ...", the comment and the program. Empty texts
// give no line.
std::vector<std::string> info_lines(const MeshFileInfo& info);

// Collects small pieces into large writes.
class BufferedOutput {
 public:
  explicit BufferedOutput(OutputFile& file) : file_(file) {}
  void append(std::string_view bytes) {
    buffer_.append(bytes);
    if (buffer_.size() >= kFlushBytes) flush();
  }
  template <typename T>
  void append_value(T value) {
    append({reinterpret_cast<const char*>(&value), sizeof value});
  }
  void flush() {
    file_.write(buffer_.data(), buffer_.size());
    buffer_.clear();
  }

 private:
  static constexpr std::size_t kFlushBytes = std::size_t{1} << 16;
  OutputFile& file_;
  std::string buffer_;
};

}  // namespace astrolith
