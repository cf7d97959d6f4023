// A Gabor layer as surface noise on a body, at one point and over many points at once.
//
// Impulses lie in a grid of cells in space, so many in each cell. Every cell has the tangent frame of the
// body's level set through its centre, and a kernel fades with the distance along its cell's normal
// (gabor_kernel.h): the noise is C1 wherever points move, whatever the frames do from cell to cell. On
// a flat patch it has the spectrum of the lobes, and the layer's variance exactly. First tangent axis: east,
// about +z; second: south, so that a patch seen from outside with north up shows the texture upright.
#pragma once

#include <cstdint>

#include "numerics/arrays.h"
#include "numerics/interval.h"
#include "recipe/recipe.h"
#include "synthesis/gabor/gabor_cells.h"
#include "synthesis/gabor/gabor_kernel.h"

namespace astrolith {

struct GaborTileCache;  // synthesis/gabor/gabor_tiles.h

// The noise and its slope at a point, with one more impulse.
ASTROLITH_KERNEL GaborSample with_impulse(const GaborImpulse& impulse, float amplitude, const Vec3f& p,
                                          const GaborSample& sum) {
  const GaborSample k = gabor_kernel_with_slope(impulse, p.x, p.y, p.z);
  return {math::fma(amplitude, k.value, sum.value),
          {math::fma(amplitude, k.slope.x, sum.slope.x), math::fma(amplitude, k.slope.y, sum.slope.y),
           math::fma(amplitude, k.slope.z, sum.slope.z)}};
}
// A coordinate of a tetrahedron's centre, from those of the four corners.
ASTROLITH_KERNEL float tetrahedron_center(float a, float b, float c, float d) {
  return 0.25f * ((a + b) + (c + d));
}
// The height at a corner, to first order about the centre.
ASTROLITH_KERNEL float height_beside(const GaborSample& center, float dx, float dy, float dz, float clip) {
  const float rise = math::fma(dx, center.slope.x, math::fma(dy, center.slope.y, dz * center.slope.z));
  return math::clamp(center.value + rise, -clip, clip);
}

struct GaborSurfaceNoise {
  Vec3f low, high;            // points outside are moved to the border
  float clip = 0.0f;          // heights are cut at 6 times the standard deviation
  double height_bound = 0.0;  // |n(p)| never exceeds it, length units
  ArrayRange<SurfaceBand> bands;
};

// Points outside `domain` are moved to its border. Bands so fine that float coordinates within it could not
// tell neighbouring cells apart (above 2^20 cells from the origin) are left out. Heights are 0 on average,
// with standard deviation layer.height_rms.
GaborSurfaceNoise make_noise(const GaborLayer& layer, std::uint64_t seed, int layer_index, const Box& domain,
                             ArrayStore& arrays);

// The cells that the impulses of all bands are drawn from, for a box with sides so long.
double cells_of(const GaborSurfaceNoise& noise, const ArrayView& arrays, double side);

// The height at a point of the bare surface, length units, from lists of impulses: band b has
// impulses[first[b]] to impulses[first[b + 1] - 1].
ASTROLITH_HD inline float height_at(const GaborSurfaceNoise& n, const ArrayView& arrays,
                                    const GaborImpulse* impulses, const std::uint32_t* first,
                                    const Vec3f& at) {
  const Vec3f p = moved_into(at, n.low, n.high);
  const SurfaceBand* bands = arrays[n.bands];
  float height = 0.0f;
  for (std::uint32_t b = 0; b < n.bands.count; ++b) {
    for (std::uint32_t j = first[b]; j < first[b + 1]; ++j) {
      height = math::fma(bands[b].amplitude, gabor_kernel(impulses[j], p.x, p.y, p.z), height);
    }
  }
  return math::clamp(height, -n.clip, n.clip);
}

// The heights at the four corners p of a small tetrahedron, to first order about their centre.
ASTROLITH_HD inline void tetrahedron_heights(const GaborSurfaceNoise& n, const ArrayView& arrays,
                                             const GaborImpulse* impulses, const std::uint32_t* first,
                                             const Vec3f* p, float* heights) {
  const Vec3f center{tetrahedron_center(p[0].x, p[1].x, p[2].x, p[3].x),
                     tetrahedron_center(p[0].y, p[1].y, p[2].y, p[3].y),
                     tetrahedron_center(p[0].z, p[1].z, p[2].z, p[3].z)};
  const Vec3f q = moved_into(center, n.low, n.high);
  const SurfaceBand* bands = arrays[n.bands];
  GaborSample sum{};
  for (std::uint32_t b = 0; b < n.bands.count; ++b) {
    for (std::uint32_t j = first[b]; j < first[b + 1]; ++j) {
      sum = with_impulse(impulses[j], bands[b].amplitude, q, sum);
    }
  }
  for (int k = 0; k < 4; ++k) {
    heights[k] = height_beside(sum, p[k].x - center.x, p[k].y - center.y, p[k].z - center.z, n.clip);
  }
}

// height[i] = n(p_i) at points of the bare surface: the bits of height_at, vectorised. `caches` has one
// element a band.
void evaluate_heights(const GaborSurfaceNoise& noise, const GaborGround& ground, const GaborTileCache* caches,
                      int n, const float* x, const float* y, const float* z, float* height);

// height[i] at the corners of small tetrahedra, four after four, to first order about their centres: for
// differences, and about as dear as one point each.
void evaluate_tetrahedron_heights(const GaborSurfaceNoise& noise, const GaborGround& ground,
                                  const GaborTileCache* caches, int n, const float* x, const float* y,
                                  const float* z, float* height);

ASTROLITH_HD inline Interval bound_heights(const GaborSurfaceNoise& n, const ArrayView&, const Box&) {
  return {-n.height_bound, n.height_bound};
}

}  // namespace astrolith
