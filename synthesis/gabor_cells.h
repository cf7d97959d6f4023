// Draws the impulses of cells of one bandwidth of surface noise (gabor_surface_noise.h). They follow from the
// seed, the cell and the body alone.
#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "synthesis/combined_body.h"
#include "synthesis/gabor_bands.h"
#include "synthesis/gabor_kernel.h"

namespace astrolith {

// A band of a layer at the body's scale.
struct SurfaceBand {
  GaborBand band;
  std::uint32_t seed;
  float a;      // cycles per length unit
  float cell;   // side, length units
  float reach;  // of a kernel from its impulse, length units
  int impulses_per_cell;
  float amplitude;  // of a kernel, length units
  float farthest;   // impulses farther than this from the surface, to first order, are left out; length units
};

using GaborCell = std::array<int, 3>;

// The impulses of cells, one cell after another. A cell has the tangent frame of the body's level set through
// its centre.
std::vector<GaborImpulse> draw_cells(const SurfaceBand& band, const PreparedBody& body,
                                     std::span<const GaborCell> cells);

}  // namespace astrolith
