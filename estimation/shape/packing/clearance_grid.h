// How far every place inside a closed body is from its surface, on a cubic grid.
//
// Cells that the surface crosses, and their neighbours, know their nearest point of the surface exactly; the
// others take the nearest of what their neighbours know (vector distance transform, Danielsson 1980), which
// is never too small and seldom too large by more than a tenth of a step.
#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "geometry/surface/surface_tree.h"
#include "geometry/triangle_mesh.h"

namespace astrolith {

struct ClearanceGrid {
  Vec3d origin;                  // centre of cell (0, 0, 0)
  double step = 1.0;             // edge of a cell
  std::array<int, 3> cells{};    // along x, y, z
  std::vector<float> clearance;  // (z y x) distance from the surface; 0 or less outside

  std::size_t index(int x, int y, int z) const {
    return (static_cast<std::size_t>(z) * static_cast<std::size_t>(cells[1]) + static_cast<std::size_t>(y)) *
               static_cast<std::size_t>(cells[0]) +
           static_cast<std::size_t>(x);
  }
  Vec3d center(int x, int y, int z) const { return origin + Vec3d{step * x, step * y, step * z}; }
  Vec3d center(std::size_t index) const;
};

inline constexpr double kMaxGridCells = 4e7;

// A grid whose cells inside the body are about `inner_cells`, fewer where the body's box would then hold more
// than `max_cells`. `body` is closed with positive volume; `tree` was made of it.
ClearanceGrid make_clearance_grid(const TriangleMesh& body, const SurfaceTree& tree, double inner_cells,
                                  double max_cells = kMaxGridCells);

}  // namespace astrolith
