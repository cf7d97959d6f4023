// A spot layer of the recipe (thesis eq. 5.3 to 5.6): its heights at one point, over many points, and as
// bounds over boxes, with its kernel (eq. 5.3, 5.5 and 5.6) and the draw of its impulses, on CPU and GPU.
//
// The impulses of a cell are hashes of the cell. To evaluate points, the impulses whose spots reach them are
// drawn in the order of the cells. A spot contributes exactly 0 beyond its support. The bits of a height
// therefore do not depend on other impulses that were drawn.
#pragma once

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <memory>
#include <vector>

#include "numerics/arrays.h"
#include "numerics/hash_random.h"
#include "numerics/host_device.h"
#include "numerics/interval.h"
#include "numerics/portable_double.h"
#include "numerics/scalar_math.h"
#include "recipe/recipe.h"
#include "synthesis/noise/cell_share.h"
#include "synthesis/noise/noise_frame.h"
#include "synthesis/noise/noise_traits.h"

namespace astrolith {

// The position of a spot, and its weight.
struct SpotImpulse {
  float x, y, z;  // length units
  float weight;
};

// The kernel K(p) = gaussian exp(-alpha q.q) + kappa exp(-beta log^2(gamma q.q)) with q = matrix p. It is cut
// where q.V^-1 q > sigma; V is a diagonal matrix of variances.
struct SpotKernel {
  float xx, xy, xz, yx, yy, yz, zx, zy, zz;  // matrix from length units to q: it rotates, then scales
  float gaussian, alpha;                     // gaussian in length units, with amplitude and sign
  float kappa, beta, gamma;                  // kappa in length units, with amplitude and sign
  float inverse_vx, inverse_vy, inverse_vz, sigma;
};

// The kernel K at the squared distance q2, without the cut. The thesis prints beta = -10 in a figure where
// the formula needs +10.
ASTROLITH_KERNEL float spot_profile(const SpotKernel& k, float q2) {
  const float log_ring = math::log(k.gamma * q2);
  return math::fma(k.gaussian, math::exp(-k.alpha * q2),
                   k.kappa * math::exp(-k.beta * (log_ring * log_ring)));
}

// Returns weight K(p - impulse), length units. It is exactly 0 where q.V^-1 q > sigma.
ASTROLITH_KERNEL float spot_height(const SpotKernel& k, const SpotImpulse& impulse, float x, float y,
                                   float z) {
  const float dx = x - impulse.x, dy = y - impulse.y, dz = z - impulse.z;
  const float qx = math::fma(k.xx, dx, math::fma(k.xy, dy, k.xz * dz));
  const float qy = math::fma(k.yx, dx, math::fma(k.yy, dy, k.yz * dz));
  const float qz = math::fma(k.zx, dx, math::fma(k.zy, dy, k.zz * dz));
  const float xx = qx * qx, yy = qy * qy, zz = qz * qz;
  const float inside = math::fma(xx, k.inverse_vx, math::fma(yy, k.inverse_vy, zz * k.inverse_vz));
  const float height = impulse.weight * spot_profile(k, xx + (yy + zz));
  return inside <= k.sigma ? height : 0.0f;
}

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
ASTROLITH_HD void for_each_cell_spot(const SpotLattice& lattice, const std::uint32_t* thresholds, int a,
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
      for_each_cell_spot(kind.lattice, thresholds, a, b, c, keep);
    }
  }
}

// The largest numbers of cells, and of impulses on average, that are drawn at once.
inline constexpr double kMostSpotCells = 4096.0, kMostSpots = 65536.0;
inline constexpr double kSpotSlack = 1e-5;  // relative slack for the rounding of positions and kernels

// The ranges over a box of two squares in the axes of the kernel: q.q, and q.V^-1 q, which decides the cut.
struct SpotSquares {
  Interval plain, cut;
};
ASTROLITH_HD inline SpotSquares spot_squares(const SpotKernel& k, const SpotImpulse& p, const Box& box) {
  const Vec3d at{double{p.x}, double{p.y}, double{p.z}}, low = box.min - at, high = box.max - at;
  SpotSquares squares;
  const auto add = [&](float along_x, float along_y, float along_z, float inverse_v) {
    const auto lower = [](float m, double a, double b) { return double{m} * (m > 0.0f ? a : b); };
    const double least =
        lower(along_x, low.x, high.x) + lower(along_y, low.y, high.y) + lower(along_z, low.z, high.z);
    const double most =
        lower(along_x, high.x, low.x) + lower(along_y, high.y, low.y) + lower(along_z, high.z, low.z);
    const double nearest = std::max(std::max(0.0, least), -most),
                 farthest = std::max(std::fabs(least), std::fabs(most));
    squares.plain.low += nearest * nearest;
    squares.plain.high += farthest * farthest;
    squares.cut.low += double{inverse_v} * nearest * nearest;
    squares.cut.high += double{inverse_v} * farthest * farthest;
  };
  add(k.xx, k.xy, k.xz, k.inverse_vx);
  add(k.yx, k.yy, k.yz, k.inverse_vy);
  add(k.zx, k.zy, k.zz, k.inverse_vz);
  return squares;
}

// The range of spot_profile() over squared distances. One term falls with the distance; the other rises up to
// its ring and falls beyond.
ASTROLITH_HD inline Interval bound_spot_profile(const SpotKernel& k, const Interval& q2) {
  const auto bowl = [&](double q) { return portable::exp(-double{k.alpha} * q); };
  const auto ring = [&](double q) {
    const double log_ring = portable::log(std::max(double{k.gamma} * q, 1e-38));
    return portable::exp(-double{k.beta} * log_ring * log_ring);
  };
  const Interval fall = scaled(double{k.gaussian}, {bowl(q2.high), bowl(q2.low)});
  if (k.kappa == 0.0f) return fall;
  const double at_ring = clamped(1.0 / double{k.gamma}, q2.low, q2.high);
  return plus(fall, scaled(double{k.kappa}, {std::min(ring(q2.low), ring(q2.high)), ring(at_ring)}));
}

// Bounds the sum of spots of one kind over a box. Spots are added one at a time.
struct SpotSumBound {
  const SpotKind& kind;
  const Box& box;
  Interval sum{};

  ASTROLITH_HD void add(const SpotImpulse& impulse) {
    const SpotKernel& k = kind.kernel;
    const double sigma = double{k.sigma};
    const SpotSquares q2 = spot_squares(k, impulse, box);
    if (q2.cut.low > sigma * (1.0 + kSpotSlack)) return;
    Interval profile =
        bound_spot_profile(k, {q2.plain.low * (1.0 - kSpotSlack), q2.plain.high * (1.0 + kSpotSlack)});
    if (q2.cut.high > sigma * (1.0 - kSpotSlack)) {
      profile = {std::min(0.0, profile.low), std::max(0.0, profile.high)};
    }
    sum.low += double{impulse.weight} * profile.low;
    sum.high += double{impulse.weight} * profile.high;
  }
  ASTROLITH_HD Interval clipped() const {
    const double clip = double{kind.clip};
    return {clamped(sum.low, -clip, clip), clamped(sum.high, -clip, clip)};
  }
};

// Whether too many impulses lie around a box to be drawn at once.
ASTROLITH_HD inline bool too_many_spots(const SpotKind& kind, const Box& box) {
  const double cells = spot_cells_around(kind, box).count();
  return cells > kMostSpotCells || cells * kind.lattice.probability * kind.lattice.density > kMostSpots;
}

// An interval that holds the clipped sum of all spots of a kind over the box. If too many cells lie around
// the box, the impulses are not drawn, and the interval is the range of the clip.
ASTROLITH_HD inline Interval bound_drawn_spots(const SpotKind& kind, const std::uint32_t* thresholds,
                                               const Box& box) {
  const double clip = double{kind.clip};
  if (too_many_spots(kind, box)) return {-clip, clip};
  SpotSumBound bound{kind, box};
  for_each_spot(kind, thresholds, box, [&](const SpotImpulse& impulse) { bound.add(impulse); });
  return bound.clipped();
}

struct SpotNoise {
  static constexpr NoiseTraits kTraits{.on_surface = false,
                                       .lifts = false,
                                       .has_heights = true,
                                       .bounded_by_box = true,
                                       .local_form = false,
                                       .lists = NoiseLists::kSpots};

  Vec3f low, high;  // points outside are moved to the border
  ArrayRange<SpotKind> kinds;
  ArrayRange<std::uint32_t> thresholds;  // shared by the lattices of all kinds
  double height_bound = 0.0;             // bound of |n(p)|, length units
  NoiseDetail detail;
};

// `layer_index` is the layer's number in the recipe; layers of one seed are independent. The domain of the
// frame holds the surface; points outside it are moved to its border. Sizes whose lattices reach beyond 2^20
// cells from the frame's origin are left out, since float coordinates could not tell neighbouring cells
// apart.
SpotNoise make_noise(const SpotLayer& layer, std::uint64_t seed, int layer_index, const NoiseFrame& frame,
                     ArrayStore& arrays);

// The drawn impulses of each kind.
using SpotImpulses = std::vector<std::vector<SpotImpulse>>;

// The impulses whose spots reach a box, for each kind. They are chosen from `larger_box_impulses`, which hold
// those of a larger box, or drawn if that is null. Returns null if there are too many to be drawn at once.
std::shared_ptr<const SpotImpulses> gather_spots(const SpotNoise& noise, const ArrayView& arrays,
                                                 const Box& box, const SpotImpulses* larger_box_impulses);

// The impulses of one kind whose spots may reach the box, in the order of their cells (z, then y, then x).
std::vector<SpotImpulse> draw_spots(const SpotKind& kind, const std::uint32_t* thresholds, const Box& box);

// The number of cells that impulses are drawn from for a cubic box; `side` is in length units.
double count_cells(const SpotNoise& noise, const ArrayView& arrays, double side);

// The number of cells and impulses that are drawn on average for a point by itself.
double draws_at_a_point(const SpotNoise& noise, const ArrayView& arrays);

// The height n(p), length units, from lists of the impulses that reach p: kind k has impulses[first[k]] to
// impulses[first[k + 1] - 1].
ASTROLITH_HD inline float height_at(const SpotNoise& n, const ArrayView& arrays, const SpotImpulse* impulses,
                                    const std::uint32_t* first, const Vec3f& at) {
  const Vec3f p = moved_into(at, n.low, n.high);
  const SpotKind* kinds = arrays[n.kinds];
  float height = 0.0f;
  for (std::uint32_t k = 0; k < n.kinds.count; ++k) {
    float sum = 0.0f;
    for (std::uint32_t j = first[k]; j < first[k + 1]; ++j) {
      sum += spot_height(kinds[k].kernel, impulses[j], p.x, p.y, p.z);
    }
    height += math::clamp(sum, -kinds[k].clip, kinds[k].clip);
  }
  return height;
}

// Writes height[i] = n(p_i), length units. `impulses` must hold all impulses that reach the points, or be
// null.
void evaluate_heights(const SpotNoise& n, const ArrayView& arrays, int count, const float* x, const float* y,
                      const float* z, float* height, const SpotImpulses* impulses = nullptr);

// An interval that holds n(p) for every float point p of a box, length units.
ASTROLITH_HD inline Interval bound_heights(const SpotNoise& n, const ArrayView& arrays, const Box& box) {
  const Box moved = moved_into(box, n.low, n.high);
  const double slack = 3.0 * kSpotSlack * n.height_bound;
  Interval sum{-slack, slack};
  for (std::uint32_t k = 0; k < n.kinds.count; ++k) {
    sum = plus(sum, bound_drawn_spots(arrays[n.kinds][k], arrays[n.thresholds], moved));
  }
  return sum;
}
// Finds this interval from `impulses`, which must hold all impulses whose spots reach the box. If `impulses`
// is null, the impulses are drawn.
Interval bound_heights(const SpotNoise& n, const ArrayView& arrays, const Box& box,
                       const SpotImpulses* impulses);

}  // namespace astrolith
