// Draws the impulses of one kind of spots that reach a box, cell by cell, on CPU and GPU.
#pragma once

#include <algorithm>
#include <cmath>
#include <cstdint>

#include "numerics/hash_random.h"
#include "numerics/interval.h"
#include "synthesis/noise/cell_share.h"
#include "synthesis/spots/spot_kernel.h"

namespace astrolith {

// The lattice in whose cells the impulses of one size lie (thesis 5.3.1, figure 5.5).
struct SpotLattice {
  Vec3f a, b, c;       // edges of a cell, length units
  Vec3d cells_per[3];  // rows of the inverse matrix: position to cells, per length unit
  std::uint32_t seed;
  double probability;  // probability of a cell to hold impulses
  double density;      // impulses of a cell that holds some, on average
  double reach;        // distance of an impulse beyond its cell and a margin for rounding, in cells
  float width;         // side of the range of a cell's impulses, in cells
  float least_weight;
  // The thresholds of this lattice in a shared array. A cell has l + 1 impulses if its hash reaches the l-th
  // threshold and not the next.
  std::uint32_t first_threshold, num_thresholds;
  std::int64_t first_cell[3] = {0, 0, 0};  // number of the cell that cells are counted from
};

// One part of the spots of one size. All parts of a size share their impulses; each part moves them by its
// offset.
struct SpotKind {
  SpotKernel kernel;
  SpotLattice lattice;
  Vec3d offset;   // from the impulse to the centre of the part, and from the origin of a patch to its first
                  // cell; length units
  Vec3d support;  // half the sides of the box around a spot, length units
  float clip;     // limit of |sum|, length units
};

// The cells first to last along each edge of the lattice.
struct SpotCells {
  int first[3], last[3];

  ASTROLITH_HD double count() const {
    return (double(last[0]) - first[0] + 1) * (double(last[1]) - first[1] + 1) *
           (double(last[2]) - first[2] + 1);
  }
};

// The cells whose impulses may reach a box.
ASTROLITH_HD inline SpotCells spot_cells_around(const SpotKind& kind, const Box& box) {
  const Vec3d low = box.min - kind.offset - kind.support, high = box.max - kind.offset + kind.support;
  SpotCells cells;
  for (int i = 0; i < 3; ++i) {
    const Vec3d& per = kind.lattice.cells_per[i];
    const auto lower = [](double k, double least, double most) { return k * (k > 0.0 ? least : most); };
    const double from =
        lower(per.x, low.x, high.x) + lower(per.y, low.y, high.y) + lower(per.z, low.z, high.z);
    const double to = lower(per.x, high.x, low.x) + lower(per.y, high.y, low.y) + lower(per.z, high.z, low.z);
    cells.first[i] = static_cast<int>(std::floor(from - kind.lattice.reach));
    cells.last[i] = static_cast<int>(std::floor(to + kind.lattice.reach));
  }
  return cells;
}

// Whether a spot, with a box of these half sides around it, touches the box.
ASTROLITH_HD inline bool spot_reaches(const SpotImpulse& impulse, const Vec3d& half, const Box& box) {
  const auto overlaps = [](double c, double low, double high, double h) {
    return c >= low - h && c <= high + h;
  };
  return overlaps(double{impulse.x}, box.min.x, box.max.x, half.x) &&
         overlaps(double{impulse.y}, box.min.y, box.max.y, half.y) &&
         overlaps(double{impulse.z}, box.min.z, box.max.z, half.z);
}

// The box, widened by the rounding of float positions.
ASTROLITH_HD inline Box spot_box(const Box& box) { return widened(box, 2e-6 * largest_coordinate(box)); }

// Calls visit(impulse) for the impulses of one cell, without any offset.
template <typename Visit>
ASTROLITH_HD void for_each_spot_of_cell(const SpotLattice& lattice, const std::uint32_t* thresholds, int a,
                                        int b, int c, Visit&& visit) {
  constexpr std::uint32_t kCountStream = 0x636f756eu, kOccupiedStream = 0x6f636375u;
  const std::uint32_t cell = hash_wide_cell(lattice.seed, lattice.first_cell[0] + a,
                                            lattice.first_cell[1] + b, lattice.first_cell[2] + c);
  if (!(static_cast<double>(unit_float(hash_append(cell, kOccupiedStream))) < lattice.probability)) return;
  const std::uint32_t number = hash_append(cell, kCountStream);
  for (std::uint32_t l = 0; l < lattice.num_thresholds && number >= thresholds[lattice.first_threshold + l];
       ++l) {
    const auto random = [&](std::uint32_t k) { return unit_float(hash_append(cell, 4 * l + k)); };
    const auto along = [&](int index, std::uint32_t k) {
      return static_cast<float>(index) + math::fma(lattice.width, random(k) - 0.5f, 0.5f);
    };
    const float ea = along(a, 0), eb = along(b, 1), ec = along(c, 2);
    const auto at = [&](float u, float v, float w) { return math::fma(u, ea, math::fma(v, eb, w * ec)); };
    visit(SpotImpulse{at(lattice.a.x, lattice.b.x, lattice.c.x), at(lattice.a.y, lattice.b.y, lattice.c.y),
                      at(lattice.a.z, lattice.b.z, lattice.c.z),
                      math::fma(1.0f - lattice.least_weight, random(3), lattice.least_weight)});
  }
}

// Calls visit(impulse) for the impulses whose spots may reach points of the box, with the offset added. The
// order is that of their cells (z, then y, then x). A share of them stands for that share of the rows of
// cells along x.
template <typename Visit, class Share = AllCells>
ASTROLITH_HD void for_each_spot(const SpotKind& kind, const std::uint32_t* thresholds, const Box& box,
                                Visit&& visit, const Share& share = {}) {
  const Box wide = spot_box(box);
  const SpotCells cells = spot_cells_around(kind, wide);
  const Vec3f offset = to_float(kind.offset);
  const auto keep = [&](SpotImpulse impulse) {
    impulse.x += offset.x;
    impulse.y += offset.y;
    impulse.z += offset.z;
    if (spot_reaches(impulse, kind.support, wide)) visit(impulse);
  };
  const auto length = [&](int axis) {
    return static_cast<std::uint64_t>(std::max(cells.last[axis] - cells.first[axis] + 1, 0));
  };
  const std::uint64_t rows = length(1) * length(2), end = share.end(rows);
  for (std::uint64_t row = share.begin(rows); row < end; ++row) {
    const int b = cells.first[1] + static_cast<int>(row % length(1));
    const int c = cells.first[2] + static_cast<int>(row / length(1));
    for (int a = cells.first[0]; a <= cells.last[0]; ++a) {
      for_each_spot_of_cell(kind.lattice, thresholds, a, b, c, keep);
    }
  }
}

}  // namespace astrolith
