// The distance of every place inside a closed body from its surface, on a cubic grid.
//
// Cells at the surface find their nearest point of the surface exactly. Every other cell takes the nearest of
// the points that its neighbours have found (vector distance transform, Danielsson 1980). The distance is
// never too small, and it is seldom too large by more than a tenth of a step.
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
  std::vector<float> clearance;  // (z y x) distance of the cell's centre from the surface; 0 outside

  std::size_t index(int x, int y, int z) const {
    return (static_cast<std::size_t>(z) * static_cast<std::size_t>(cells[1]) + static_cast<std::size_t>(y)) *
               static_cast<std::size_t>(cells[0]) +
           static_cast<std::size_t>(x);
  }
  Vec3d center(int x, int y, int z) const { return origin + Vec3d{step * x, step * y, step * z}; }
  Vec3d center(std::size_t index) const;
};

inline constexpr double kMaxGridCells = 4e7;

// Makes a grid with about `inner_cells` cells inside the body. It has fewer if the body's bounding box would
// otherwise hold more than `max_cells`. `body` is closed with positive volume, and `tree` was made of it.
ClearanceGrid make_clearance_grid(const TriangleMesh& body, const SurfaceTree& tree, double inner_cells,
                                  double max_cells = kMaxGridCells);

}  // namespace astrolith
