// Gabor noise of one band on a square tile of pixels in the plane.
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

// The side, in pixels, of the square tile that one task makes. The heights of a tile stay in the first cache.
inline constexpr int kTextureTile = 64;

struct TextureTile {
  int x, y;  // first column and row
  std::array<float, std::size_t{kTextureTile * kTextureTile}> height;
};

// Adds the noise of a band to the heights of a tile.
void add_band(const PlaneBand& band, TextureTile& tile);

}  // namespace astrolith
