// The cubic lattice a field is sampled on. A sample's position depends on its index alone, never on the block
// it is computed in, so that any decomposition gives the same bits.
#pragma once

#include <array>

#include "numerics/vec3.h"

namespace astrolith {

struct SampleGrid {
  Vec3d origin;              // position of sample (0, 0, 0)
  double step = 1.0;         // edge of a cell, length units
  std::array<int, 3> cells;  // along x, y, z; there is one sample more

  float x(int index) const { return static_cast<float>(origin.x + step * index); }
  float y(int index) const { return static_cast<float>(origin.y + step * index); }
  float z(int index) const { return static_cast<float>(origin.z + step * index); }

  // The box of the samples first .. last, widened by margin (length units) on every side.
  Box box(const std::array<int, 3>& first, const std::array<int, 3>& last, double margin) const;
};

inline constexpr int kMinResolution = 4;
inline constexpr int kMaxResolution = 8192;

// A grid of `resolution` cells along the longest side of bounds, one cell of it as padding on each end, so
// that a surface within bounds never touches the border. Throws InputError when bounds are empty or not
// finite, the resolution is outside [kMinResolution, kMaxResolution], or neighbouring positions could not be
// told apart in 32-bit floats.
SampleGrid make_sample_grid(const Box& bounds, int resolution);

}  // namespace astrolith
