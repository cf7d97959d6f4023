// The header of a PLY file (Turk 1994): its elements, their counts, and the properties in each row.
#pragma once

#include <bit>
#include <cstdint>
#include <string>
#include <vector>

#include "geometry/io/mesh_file_internal.h"
#include "geometry/io/text_scanner_internal.h"

namespace astrolith {

enum class PlyType { int8, uint8, int16, uint16, int32, uint32, float32, float64 };

std::size_t size_of(PlyType type);

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

}  // namespace astrolith
