// What the formats of meshes share: a file in memory, the one form of readers' error messages, the text of
// files about themselves, and one reader and one writer for each format.
#pragma once

#include <array>
#include <charconv>
#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "geometry/io/mesh_format.h"
#include "geometry/io/mesh_io.h"
#include "numerics/errors.h"
#include "numerics/files/output_file.h"

namespace astrolith {

// In front of the numbers of MeshFileInfo::origin, of a part of a body and of a whole one.
inline constexpr std::string_view kPartOriginWords = "origin, to be added to all coordinates: ";
inline constexpr std::string_view kBodyOriginWords = "origin of the body, to be added to all coordinates: ";

struct MeshFile {
  std::filesystem::path path;
  std::string bytes;
  std::string label = {};  // of the Planetary Data System, from in front of the data

  // Throws InputError("FILE: place: what; remedy"). An empty place is left out.
  [[noreturn]] void fail(std::string_view place, std::string_view what, std::string_view remedy) const;
};

// Reads the whole file, and unpacks Zstandard and gzip, to at most 100 times the file's size. Throws
// InputError when it is missing, empty, a folder, or not a plain file.
MeshFile load_mesh_file(const std::filesystem::path& path);

// At most 40 characters of a piece of a file, in quotes, for a one-line message. Characters that are not
// printable ASCII become '?'.
std::string quoted(std::string_view piece);

// Vertex indices have 32 bits, in TriangleMesh and in every binary format.
inline constexpr std::int64_t kMaxVertices = std::int64_t{0xffffffff};

// Splits a quadrilateral into two triangles along its shorter diagonal.
void append_quad(const std::vector<Vec3d>& points, const std::array<std::uint32_t, 4>& corners,
                 std::vector<Triangle>& out);

// The polygons of a file. They become fans around their first corners while the file is read. Those that such
// a fan does not cover are cut by their ears once all vertices are known: a face may stand before its
// vertices.
class PolygonFans {
 public:
  void append(std::span<const std::uint32_t> polygon, std::vector<Triangle>& triangles);
  // Throws InputError where polygons that are not convex have more corners than kMostSquaredCorners allows.
  // Passes over polygons with indices out of range.
  void cut_concave(const MeshFile& file, TriangleMesh& mesh) const;

 private:
  struct Fan {
    std::size_t first, count;  // triangles
  };
  std::vector<Fan> fans_;  // of four corners and more
};

// Reads the file by the format that its name and its content tell. Throws InputError when the extension names
// one format and the content is clearly another, and when neither tells the format.
TriangleMesh read_content(const MeshFile& file);

// Whether the content is of a format of meshes, or begins as one of the kinds that refuse_other_kinds()
// knows.
bool looks_like_mesh(const MeshFile& file);

// The mesh of a file that may have no faces. Throws InputError as read_mesh does otherwise.
TriangleMesh read_any(const MeshFile& file);

// Throws InputError for a file that begins as one of the kinds that are no mesh and no table: pictures,
// archives, kernels, scenes of other programs. `remedy` is for those that need no other.
void refuse_other_kinds(const MeshFile& file, const std::string& remedy);

// Readers may leave indices out of range and coordinates that are not finite; read_mesh checks both.
TriangleMesh read_obj(const MeshFile& file);
TriangleMesh read_ply(const MeshFile& file);
TriangleMesh read_stl_ascii(const MeshFile& file);
TriangleMesh read_stl_binary(const MeshFile& file);
TriangleMesh read_off(const MeshFile& file);
TriangleMesh read_plate(const MeshFile& file);
TriangleMesh read_icq(const MeshFile& file);
TriangleMesh read_bmf(const MeshFile& file);
TriangleMesh read_glb(const MeshFile& file);
bool is_glb(const MeshFile& file);
TriangleMesh read_dsk(const MeshFile& file);
bool is_dsk(const MeshFile& file);
// A table of latitude, longitude and radius.
TriangleMesh read_grid_table(const MeshFile& file);
bool is_grid_table(const MeshFile& file);

// Writers rely on what write_mesh has checked: at least one triangle, indices in range, and coordinates that
// float32 can hold.
void write_ply(const TriangleMesh& mesh, const std::filesystem::path& file, const MeshFileInfo& info);
void write_obj(const TriangleMesh& mesh, const std::filesystem::path& file, const MeshFileInfo& info);
void write_stl(const TriangleMesh& mesh, const std::filesystem::path& file, const MeshFileInfo& info);
void write_glb(const TriangleMesh& mesh, const std::filesystem::path& file, const MeshFileInfo& info);
void write_glb_levels(std::span<const MeshLevel> levels, std::span<const double> coverage,
                      const std::filesystem::path& file, const MeshFileInfo& info);
// The two formats of plates have no place for comments. write_icq throws InputError for a body that has
// several surfaces along a direction from its centre of mass.
void write_icq(const TriangleMesh& mesh, const std::filesystem::path& file, const MeshFileInfo& info);
// The vertices and triangles of the .icq of a mesh.
MeshCounts icq_counts(const MeshCounts& mesh);
void write_plate(const TriangleMesh& mesh, const std::filesystem::path& file, const MeshFileInfo& info);

// The lines of a file's comment: "length unit: km", "frame: ...", the comment and the program. Empty texts
// give no line.
std::vector<std::string> info_lines(const MeshFileInfo& info);

// Appends numbers, blanks between them: whole numbers, and doubles as the shortest decimals that read back as
// the same double.
template <typename... Number>
void append_words(std::string& line, const Number&... numbers) {
  const auto append = [&](const auto& number) {
    char digits[32];
    if (!line.empty()) line += ' ';
    line.append(digits, std::to_chars(digits, digits + sizeof digits, number).ptr);
  };
  (append(numbers), ...);
}
inline std::string point_text(const Vec3d& p) {
  std::string text;
  append_words(text, p.x, p.y, p.z);
  return text;
}

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
