// Draws the impulses of surface noise (gabor_surface_noise.h) in cells of one bandwidth. They depend on the
// seed, the cell and the body alone.
#pragma once

#include <array>
#include <span>
#include <vector>

#include "synthesis/body/ground_points.h"
#include "synthesis/gabor/gabor_draw.h"

namespace astrolith {

// One bandwidth of a layer, scaled to length units of the body.
struct SurfaceBand : GaborDraw {
  ArrayRange<GaborLobeShare> lobes;
};

using GaborCell = std::array<int, 3>;

// The centres of cells, and the distance and gradient of the body there.
struct GaborCellCenters : GroundPoints {
  GaborCellCenters() : GroundPoints(std::size_t{0}) {}

  // Replaces the centres by those of other cells, in the same memory.
  void find(std::span<const GaborCell> cells, const SurfaceBand& band, const BodyGround& ground);
};

// The cells of a brick.
inline constexpr std::size_t kBrickVolume{kBrickCells * kBrickCells * kBrickCells};
using BrickCells = std::array<GaborCell, kBrickVolume>;

// The impulses of the cells of a brick, in the order of the cells. The tangent frame of a cell is that of the
// level set of the body through the centre of the cell. The bits are those of for_each_gabor_impulse().
std::vector<GaborImpulse> draw_cells(const SurfaceBand& band, const BodyGround& ground,
                                     const BrickCells& cells);

}  // namespace astrolith
