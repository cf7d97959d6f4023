// Draws the impulses of surface noise (gabor_surface_noise.h) cell by cell, and tells which reach a box:
// plain code for CPU and GPU.
#pragma once

#include <cstdint>

#include "numerics/hash_random.h"
#include "synthesis/gabor/gabor_kernel.h"

namespace astrolith {

// A lobe of a band: share of the band's variance in lobes up to this one, the last's being 1, and where it
// is.
struct GaborLobeShare {
  float cumulative;
  float frequency_x, frequency_y;  // over a
};

// What impulses of one bandwidth are drawn from.
struct GaborDraw {
  std::uint32_t seed;
  float a;      // cycles per length unit
  float cell;   // side, length units
  float reach;  // of a kernel from its impulse, length units
  int impulses_per_cell;
  float amplitude;  // of a kernel, length units
  float farthest;   // impulses farther than this from the surface, to first order, are left out; length units
};

struct TangentFrame {
  Vec3f u, v, n;
};

// East, south and outward for a body whose field grows along `inward`; where the normal is within a degree of
// the z axis, x takes the place of east. Any unit vectors do where there is no gradient.
ASTROLITH_HD inline TangentFrame tangent_frame(const Vec3f& inward) {
  const float length = math::sqrt(dot(inward, inward));
  const Vec3f n = length > 1e-18f ? inward * (-1.0f / length) : Vec3f{0.0f, 0.0f, 1.0f};
  const bool polar = n.x * n.x + n.y * n.y < 3e-4f;
  const Vec3f east = polar ? Vec3f{1.0f - n.x * n.x, -n.x * n.y, -n.x * n.z} : Vec3f{-n.y, n.x, 0.0f};
  const Vec3f u = east * (1.0f / math::sqrt(dot(east, east)));
  return {u, cross(u, n), n};
}

ASTROLITH_HD inline Vec3f gabor_cell_center(int cx, int cy, int cz, float cell) {
  return {(static_cast<float>(cx) + 0.5f) * cell, (static_cast<float>(cy) + 0.5f) * cell,
          (static_cast<float>(cz) + 0.5f) * cell};
}

// Ten bits of a hash place an impulse along each axis, to a thousandth of a cell.
ASTROLITH_HD inline Vec3f point_in_gabor_cell(std::uint32_t hash, int cx, int cy, int cz, float cell) {
  const auto at = [&](int c, int shift) {
    const std::uint32_t bits = (hash >> shift) & 1023u;
    return (static_cast<float>(c) + (static_cast<float>(bits) + 0.5f) * 0x1p-10f) * cell;
  };
  return {at(cx, 2), at(cy, 12), at(cz, 22)};
}

// The lobe for a uniform number in [0, 1): the first whose share is above it.
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
  return {p.x,       p.y,       p.z,       a * f.u.x, a * f.u.y, a * f.u.z,        a * f.v.x,
          a * f.v.y, a * f.v.z, a * f.n.x, a * f.n.y, a * f.n.z, lobe.frequency_x, lobe.frequency_y,
          phase};
}

// Calls visit(impulse) for those of one cell, whose centre is `height` outside the surface of a body that
// grows along `inward` there.
template <typename Visit>
ASTROLITH_HD void for_each_gabor_impulse(const GaborDraw& band, const GaborLobeShare* lobes,
                                         std::uint32_t num_lobes, int cx, int cy, int cz, float height,
                                         const Vec3f& inward, Visit&& visit) {
  if (math::abs(height) > band.farthest + band.cell) return;
  const TangentFrame frame = tangent_frame(inward);
  const Vec3f center = gabor_cell_center(cx, cy, cz, band.cell);
  const std::uint32_t cell_hash = hash_cell(band.seed, cx, cy, cz);
  for (int j = 0; j < band.impulses_per_cell; ++j) {
    const std::uint32_t hash = hash_append(cell_hash, static_cast<std::uint32_t>(j));
    const Vec3f p = point_in_gabor_cell(hash, cx, cy, cz, band.cell);
    const float above = height + dot(frame.n, p - center);
    if (math::abs(above) > band.farthest) continue;
    // Sixteen bits choose the lobe, sixteen the phase.
    const std::uint32_t bits = hash_append(hash, 0);
    const GaborLobeShare& lobe = drawn_lobe(lobes, num_lobes, static_cast<float>(bits >> 16) * 0x1p-16f);
    visit(gabor_impulse(band.a, p, frame, lobe, static_cast<float>(bits & 0xffffu) * 0x1p-16f));
  }
}

// For the rounding of positions and frames to float.
inline constexpr float kGaborSlack = 1.0f + 1e-3f;

// How far along an axis of a kernel the nearest point of a box lies, the box's extent being `half`.
ASTROLITH_KERNEL float nearest_along(float ax, float ay, float az, float dx, float dy, float dz,
                                     const float* half) {
  const float center = math::abs(math::fma(ax, dx, math::fma(ay, dy, az * dz)));
  const float spread =
      math::fma(math::abs(ax), half[0], math::fma(math::abs(ay), half[1], math::abs(az) * half[2]));
  return center - spread;
}

// How far beyond a kernel's reach a box about `center` lies: not at all where it is not above 0.
ASTROLITH_KERNEL float beyond_gabor_reach(const GaborImpulse& k, const float* center, const float* half) {
  const float dx = center[0] - k.x, dy = center[1] - k.y, dz = center[2] - k.z;
  const float u = nearest_along(k.ux, k.uy, k.uz, dx, dy, dz, half);
  const float v = nearest_along(k.vx, k.vy, k.vz, dx, dy, dz, half);
  const float n = nearest_along(k.nx, k.ny, k.nz, dx, dy, dz, half);
  return math::max(math::max(u, v) - kGaborSlack * kGaborReach, n - kGaborSlack * kGaborSlabReach);
}

// The cells whose impulses may reach float points low .. high along an axis.
struct GaborCellSpan {
  int first, last;
};
ASTROLITH_HD inline GaborCellSpan gabor_cells_around(const GaborDraw& band, float low, float high) {
  const double cell = static_cast<double>(band.cell), reach = (1.0 + 1e-3) * static_cast<double>(band.reach);
  return {static_cast<int>(std::floor((static_cast<double>(low) - reach) / cell)),
          static_cast<int>(std::floor((static_cast<double>(high) + reach) / cell))};
}

// Cells along a side of the tiles in whose order impulses are added.
inline constexpr int kTileCells = 4;
ASTROLITH_HD inline int gabor_tile_of(int cell) {
  return cell >= 0 ? cell / kTileCells : -((-cell + kTileCells - 1) / kTileCells);
}

}  // namespace astrolith
