// Draws the impulses of surface noise (gabor_surface_noise.h) cell by cell, and decides which impulses reach
// a box. The code is plain, for CPU and GPU.
#pragma once

#include <cstdint>

#include "numerics/hash_random.h"
#include "synthesis/gabor/gabor_kernel.h"

namespace astrolith {

// A lobe of a band: the share of all lobes up to this one in the variance of the band, and the frequency of
// the lobe. The share of the last lobe is 1.
struct GaborLobeShare {
  float cumulative;
  float frequency_x, frequency_y;  // in units of a
};

// The parameters that the impulses of one bandwidth are drawn with.
struct GaborDraw {
  std::uint32_t seed;
  float a;      // bandwidth, cycles per length unit
  float cell;   // side, length units
  float reach;  // from an impulse to the corner of its support, length units
  int impulses_per_cell;
  float amplitude;  // amplitude of a kernel, length units
  float farthest;   // greatest first-order distance of an impulse from the surface, length units
  std::int64_t first_cell[3] = {0, 0, 0};  // number of the cell that cells are counted from
  Vec3f first_corner{};                    // lowest corner of that cell, length units
};

// Two unit tangent vectors and the outward unit normal.
struct TangentFrame {
  Vec3f u, v, n;
};

// The axes east, south and outward of a body whose field grows along `inward`. If the normal is within a
// degree of the z axis, x replaces east. If `inward` is 0, the normal is +z.
ASTROLITH_HD inline TangentFrame tangent_frame(const Vec3f& inward) {
  const float length = math::sqrt(dot(inward, inward));
  const Vec3f n = length > 1e-18f ? inward * (-1.0f / length) : Vec3f{0.0f, 0.0f, 1.0f};
  const bool polar = n.x * n.x + n.y * n.y < 3e-4f;
  const Vec3f east = polar ? Vec3f{1.0f - n.x * n.x, -n.x * n.y, -n.x * n.z} : Vec3f{-n.y, n.x, 0.0f};
  const Vec3f u = east * (1.0f / math::sqrt(dot(east, east)));
  return {u, cross(u, n), n};
}

ASTROLITH_KERNEL Vec3f gabor_cell_center(const GaborDraw& band, int cx, int cy, int cz) {
  const auto at = [&](int c, float first) { return (static_cast<float>(c) + 0.5f) * band.cell + first; };
  return {at(cx, band.first_corner.x), at(cy, band.first_corner.y), at(cz, band.first_corner.z)};
}

// The position of an impulse in its cell. Ten bits of the hash choose each coordinate, to a thousandth of a
// cell.
ASTROLITH_KERNEL Vec3f point_in_gabor_cell(const GaborDraw& band, std::uint32_t hash, int cx, int cy,
                                           int cz) {
  const auto at = [&](int c, int shift, float first) {
    const auto bits = static_cast<std::int32_t>((hash >> shift) & 1023u);
    return (static_cast<float>(c) + (static_cast<float>(bits) + 0.5f) * 0x1p-10f) * band.cell + first;
  };
  return {at(cx, 2, band.first_corner.x), at(cy, 12, band.first_corner.y), at(cz, 22, band.first_corner.z)};
}

// The lobe that a uniform number in [0, 1) selects: the first one whose cumulative share exceeds the number.
ASTROLITH_HD inline const GaborLobeShare& drawn_lobe(const GaborLobeShare* lobes, std::uint32_t count,
                                                     float uniform) {
  std::uint32_t first = 0, last = count - 1;
  while (first < last) {
    const std::uint32_t middle = (first + last) / 2;
    if (uniform < lobes[middle].cumulative) {
      last = middle;
    } else {
      first = middle + 1;
    }
  }
  return lobes[first];
}

ASTROLITH_HD inline GaborImpulse gabor_impulse(float a, const Vec3f& p, const TangentFrame& f,
                                               const GaborLobeShare& lobe, float phase) {
  const auto wave = [&](float u, float v) {
    return a * math::fma(lobe.frequency_x, u, lobe.frequency_y * v);
  };
  return {p.x,       p.y,       p.z,  wave(f.u.x, f.v.x), wave(f.u.y, f.v.y), wave(f.u.z, f.v.z), a * f.n.x,
          a * f.n.y, a * f.n.z, phase};
}

// The lobe and the phase of an impulse: sixteen bits of `bits` each.
ASTROLITH_HD inline const GaborLobeShare& pick_lobe(const GaborLobeShare* lobes, std::uint32_t num_lobes,
                                                    std::uint32_t bits) {
  return drawn_lobe(lobes, num_lobes, static_cast<float>(bits >> 16) * 0x1p-16f);
}
ASTROLITH_HD inline float bits_to_phase(std::uint32_t bits) {
  return static_cast<float>(bits & 0xffffu) * 0x1p-16f;
}

// How far a point of a cell lies outside the surface of a body, to first order, length units. The centre of
// the cell lies `height` outside, and n is the normal there.
ASTROLITH_KERNEL float height_in_gabor_cell(float height, float nx, float ny, float nz, const Vec3f& center,
                                            const Vec3f& p) {
  return height + (nx * (p.x - center.x) + ny * (p.y - center.y) + nz * (p.z - center.z));
}

ASTROLITH_HD inline std::uint32_t gabor_cell_hash(const GaborDraw& band, int cx, int cy, int cz) {
  const std::int64_t* first = band.first_cell;
  return hash_wide_cell(band.seed, first[0] + cx, first[1] + cy, first[2] + cz);
}

// Calls visit(impulse) for the impulses of one cell, whose tangent frame is given. The centre of the cell
// lies `height` length units outside the surface of a body.
template <typename Visit>
ASTROLITH_HD void for_each_gabor_impulse(const GaborDraw& band, const GaborLobeShare* lobes,
                                         std::uint32_t num_lobes, int cx, int cy, int cz, float height,
                                         const TangentFrame& frame, Visit&& visit) {
  const Vec3f center = gabor_cell_center(band, cx, cy, cz);
  const std::uint32_t cell_hash = gabor_cell_hash(band, cx, cy, cz);
  for (int j = 0; j < band.impulses_per_cell; ++j) {
    const std::uint32_t hash = hash_append(cell_hash, static_cast<std::uint32_t>(j));
    const Vec3f p = point_in_gabor_cell(band, hash, cx, cy, cz);
    const float above = height_in_gabor_cell(height, frame.n.x, frame.n.y, frame.n.z, center, p);
    if (math::abs(above) > band.farthest) continue;
    const std::uint32_t bits = hash_append(hash, 0);
    visit(gabor_impulse(band.a, p, frame, pick_lobe(lobes, num_lobes, bits), bits_to_phase(bits)));
  }
}

// Whether a cell is too far from the surface for all its impulses. `height` is that of its centre.
ASTROLITH_HD inline bool is_far_gabor_cell(const GaborDraw& band, float height) {
  return math::abs(height) > band.farthest + band.cell;
}

// Calls visit(impulse) for the impulses of one cell, whose tangent frame follows from `inward`. The body's
// field grows along `inward` at the centre of the cell.
template <typename Visit>
ASTROLITH_HD void for_each_gabor_impulse(const GaborDraw& band, const GaborLobeShare* lobes,
                                         std::uint32_t num_lobes, int cx, int cy, int cz, float height,
                                         const Vec3f& inward, Visit&& visit) {
  if (is_far_gabor_cell(band, height)) return;
  for_each_gabor_impulse(band, lobes, num_lobes, cx, cy, cz, height, tangent_frame(inward), visit);
}

// Slack factor for the rounding of positions and frames to float.
inline constexpr float kGaborSlack = 1.0f + 1e-3f;

// A box of points to which kernels of one bandwidth may reach.
struct GaborTarget {
  float center[3], half[3];  // its centre and half its sides, length units
  float a_squared;           // of the bandwidth a
  float disc;                // most_disc() of the box
};

// The square of the greatest distance along its tangent plane, in units of 1/a, at which a kernel may reach
// points within `radius` length units of a centre.
ASTROLITH_HD inline float most_disc(float a, float radius) {
  const float reach = kGaborSlack * (kGaborDiscReach + a * radius);
  return reach * reach;
}
ASTROLITH_HD inline GaborTarget gabor_target(float a, const float* center, const float* half) {
  const float radius = math::sqrt(half[0] * half[0] + half[1] * half[1] + half[2] * half[2]);
  return {{center[0], center[1], center[2]}, {half[0], half[1], half[2]}, a * a, most_disc(a, radius)};
}

// Whether a kernel may reach points of a box, given as the members of a GaborTarget. The answer is true for
// every kernel that reaches a point:
//
//   |n of the point| >= |n of the centre| - sum_i |N_i| half_i,
//   tangential distance of the point >= that of the centre - radius.
ASTROLITH_KERNEL bool gabor_reaches(const GaborImpulse& k, float a_squared, float cx, float cy, float cz,
                                    float hx, float hy, float hz, float disc) {
  const float dx = cx - k.x, dy = cy - k.y, dz = cz - k.z;
  const float r2 = math::fma(dx, dx, math::fma(dy, dy, dz * dz));
  const float n = math::fma(dx, k.nx, math::fma(dy, k.ny, dz * k.nz));
  const float spread = math::fma(math::abs(k.nx), hx, math::fma(math::abs(k.ny), hy, math::abs(k.nz) * hz));
  const bool in_slab = math::abs(n) - spread <= kGaborSlack * kGaborSlabReach;
  const bool in_disc = math::fma(a_squared, r2, -(n * n)) <= disc;
  return in_slab & in_disc;
}
ASTROLITH_KERNEL bool gabor_reaches(const GaborImpulse& k, const GaborTarget& to) {
  return gabor_reaches(k, to.a_squared, to.center[0], to.center[1], to.center[2], to.half[0], to.half[1],
                       to.half[2], to.disc);
}

// The cells along axis 0, 1 or 2 whose impulses may reach float points between low and high.
struct GaborCellSpan {
  int first, last;
};
ASTROLITH_HD inline GaborCellSpan gabor_cells_around(const GaborDraw& band, int axis, float low, float high) {
  const double cell = static_cast<double>(band.cell), reach = (1.0 + 1e-3) * static_cast<double>(band.reach);
  const Vec3f& corner = band.first_corner;
  const auto first = static_cast<double>(axis == 0 ? corner.x : axis == 1 ? corner.y : corner.z);
  return {static_cast<int>(std::floor((static_cast<double>(low) - first - reach) / cell)),
          static_cast<int>(std::floor((static_cast<double>(high) - first + reach) / cell))};
}

// The number of cells along a side of a brick. Impulses are added in the order of bricks.
inline constexpr int kBrickCells = 4;
ASTROLITH_HD inline int containing_gabor_brick(int cell) {
  return cell >= 0 ? cell / kBrickCells : -((-cell + kBrickCells - 1) / kBrickCells);
}

}  // namespace astrolith
