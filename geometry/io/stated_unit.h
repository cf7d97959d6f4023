// The length unit that a mesh file states: see mesh_io.h.
#pragma once

#include "geometry/io/mesh_io.h"

namespace astrolith {

inline bool tells_length_unit(const std::filesystem::path& file) {
  return written_mesh_format(file).tells_unit;
}

}  // namespace astrolith
