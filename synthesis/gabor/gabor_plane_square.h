// Gabor noise of one band on a square of pixels in the plane.
#pragma once

#include <array>
#include <cstdint>

#include "synthesis/gabor/gabor_bands.h"

namespace astrolith {

// A band on the plane. Lengths are in pixels.
struct PlaneBand {
  GaborBand band;
  std::uint32_t seed;
  double cell_x, cell_y;  // sides of a cell
  int wrap_x, wrap_y;     // cells in a period; 0: no period
  double reach;
  int impulses_per_cell;
  float amplitude;
};

// The side, in pixels, of the square that one task makes. The heights of a square stay in the first cache.
inline constexpr int kTextureSquare = 64;

struct TextureSquare {
  int x, y;  // first column and row
  std::array<float, std::size_t{kTextureSquare * kTextureSquare}> height;
};

// Adds the noise of a band to the heights of a square.
void add_band(const PlaneBand& band, TextureSquare& square);

}  // namespace astrolith
