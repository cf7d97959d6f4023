// Draws the impulses of cells of one bandwidth of surface noise (gabor_surface_noise.h). They follow from the
// seed, the cell and the body alone.
#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "synthesis/body/combined_body.h"
#include "synthesis/gabor/gabor_bands.h"
#include "synthesis/gabor/gabor_draw.h"

namespace astrolith {

// A band of a layer at the body's scale.
struct SurfaceBand : GaborDraw {
  GaborBand band;
};

using GaborCell = std::array<int, 3>;

// The impulses of cells, one cell after another. A cell has the tangent frame of the body's level set through
// its centre.
std::vector<GaborImpulse> draw_cells(const SurfaceBand& band, const PreparedBody& body,
                                     std::span<const GaborCell> cells);

}  // namespace astrolith
