// The header of a PLY file (Turk 1994): its elements, their counts, and the properties in each row; and the
// layout of the files that Astrolith writes.
#pragma once

#include <array>
#include <bit>
#include <cstdint>
#include <cstring>
#include <string>
#include <vector>

#include "geometry/io/format_internal.h"
#include "geometry/io/text_scanner_internal.h"

namespace astrolith {

enum class PlyType { int8, uint8, int16, uint16, int32, uint32, float32, float64 };

std::size_t type_size(PlyType type);

struct PlyProperty {
  std::string name;
  PlyType type{};  // type of the value, or of the entries of a list
  bool is_list = false;
  PlyType count_type{};  // type of the length of a list
};

struct PlyElement {
  std::string name;
  std::uint64_t count = 0;
  std::vector<PlyProperty> properties;

  // The fewest bytes that a row takes in a binary file: every list is empty.
  std::size_t least_row_bytes() const;
};

struct PlyHeader {
  bool ascii = false;
  std::endian order = std::endian::little;
  std::vector<PlyElement> elements;
};

// Reads the header and leaves `scan` at the end of the line "end_header".
PlyHeader read_ply_header(TextScanner& scan);

inline constexpr std::size_t kPlyTriangleBytes = 13;

// The header of a PLY file that is written. It has the same length for all counts: a comment fills up what
// the digits leave.
struct PlyVertexParts {
  bool normals = false, colors = false, labels = false;
};
std::string ply_header(const MeshFileInfo& info, std::uint64_t num_vertices, std::uint64_t num_triangles,
                       const PlyVertexParts& parts);

// Puts a triangle at `out` as one uchar, 3, and three little-endian uint32; returns where the next one goes.
inline char* put_ply_triangle(const Triangle& triangle, char* out) {
  *out = 3;
  std::memcpy(out + 1, triangle.data(), sizeof triangle);
  return out + kPlyTriangleBytes;
}

}  // namespace astrolith
