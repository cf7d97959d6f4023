// Draws the impulses of cells of one bandwidth of surface noise (gabor_surface_noise.h). They follow from the
// seed, the cell and the body alone.
#pragma once

#include <array>
#include <span>
#include <vector>

#include "synthesis/body/body_tables.h"
#include "synthesis/gabor/gabor_draw.h"

namespace astrolith {

// One bandwidth of a layer at the body's scale.
struct SurfaceBand : GaborDraw {
  ArrayRange<GaborLobeShare> lobes;
};

// The body whose level sets give cells their tangent frames, and the arrays that it and the bands lie in.
struct GaborGround {
  const BodyTables& body;
  ArrayView arrays;
  LeafLists metaballs;  // all of the body's
};

using GaborCell = std::array<int, 3>;

// The impulses of cells, one cell after another. A cell has the tangent frame of the body's level set through
// its centre.
std::vector<GaborImpulse> draw_cells(const SurfaceBand& band, const GaborGround& ground,
                                     std::span<const GaborCell> cells);

}  // namespace astrolith
