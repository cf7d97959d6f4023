// The header of a PLY file (Turk 1994): which elements follow, how often, and what their rows are made of.
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
  PlyType type{};  // of the value, or of a list's entries
  bool is_list = false;
  PlyType count_type{};  // of a list's length
};

struct PlyElement {
  std::string name;
  std::uint64_t count = 0;
  std::vector<PlyProperty> properties;

  // The fewest bytes that a row takes in a binary file, its lists being empty.
  std::size_t least_row_bytes() const;
};

struct PlyHeader {
  bool ascii = false;
  std::endian order = std::endian::little;
  std::vector<PlyElement> elements;
};

// Leaves scan at the end of the line "end_header".
PlyHeader read_ply_header(TextScanner& scan);

}  // namespace astrolith
