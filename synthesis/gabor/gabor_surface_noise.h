// A Gabor layer as noise on the surface of a body, at one point and over many points at once.
//
// Impulses lie in the cells of a grid in space, the same number in each cell. Every cell has the tangent
// frame of the level set of the body through its centre. A kernel fades with the distance along the normal of
// its cell (gabor_kernel.h). The noise is therefore C1 everywhere, even if the frames of neighbouring cells
// differ. On a flat patch it has the spectrum of the lobes, and exactly the variance of the layer. The first
// tangent axis points east about +z, the second south. A patch seen from outside with north up therefore
// shows the texture upright.
#pragma once

#include <cstdint>

#include "numerics/arrays.h"
#include "numerics/interval.h"
#include "recipe/recipe.h"
#include "synthesis/gabor/gabor_cells.h"
#include "synthesis/gabor/gabor_kernel.h"
#include "synthesis/noise/noise_frame.h"
#include "synthesis/noise/noise_traits.h"

namespace astrolith {

struct GaborBrickCache;  // synthesis/gabor/gabor_bricks.h

// The noise and its slope at a point, with one more impulse added.
ASTROLITH_KERNEL GaborSample with_impulse(const GaborImpulse& impulse, float disc_scale, float amplitude,
                                          const Vec3f& p, const GaborSample& sum) {
  const GaborSample k = gabor_kernel_with_slope(impulse, disc_scale, p.x, p.y, p.z);
  return {math::fma(amplitude, k.value, sum.value),
          {math::fma(amplitude, k.slope.x, sum.slope.x), math::fma(amplitude, k.slope.y, sum.slope.y),
           math::fma(amplitude, k.slope.z, sum.slope.z)}};
}
// One coordinate of the centre of a tetrahedron, from those of its four corners.
ASTROLITH_KERNEL float tetrahedron_center(float a, float b, float c, float d) {
  return 0.25f * ((a + b) + (c + d));
}
// The height at the offset (dx, dy, dz) from the centre, to first order, clamped to +- clip.
ASTROLITH_KERNEL float height_beside(const GaborSample& center, float dx, float dy, float dz, float clip) {
  const float rise = math::fma(dx, center.slope.x, math::fma(dy, center.slope.y, dz * center.slope.z));
  return math::clamp(center.value + rise, -clip, clip);
}

struct GaborSurfaceNoise {
  static constexpr NoiseTraits kTraits{.on_surface = true,
                                       .lifts = false,
                                       .has_heights = true,
                                       .bounded_by_box = false,
                                       .local_form = false,
                                       .lists = NoiseLists::kGabor};

  Vec3f low, high;            // points outside are moved to the border
  float clip = 0.0f;          // heights are clamped to +- clip: 6 standard deviations, length units
  double height_bound = 0.0;  // bound of |n(p)|, length units
  ArrayRange<SurfaceBand> bands;
  NoiseDetail detail;
};

// `layer_index` is the layer's number in the recipe; layers of one seed are independent. The domain of the
// frame holds the surface; points outside it are moved to its border. Bands whose grids reach beyond 2^20
// cells from the frame's origin are left out, since float coordinates could not tell neighbouring cells
// apart. Without any band left out, heights have mean 0 and the standard deviation layer.height_rms.
// `body_side` is the longest side of the box that holds the body, length units.
GaborSurfaceNoise make_noise(const GaborLayer& layer, std::uint64_t seed, int layer_index,
                             const NoiseFrame& frame, double body_side, ArrayStore& arrays);

// The number of cells that the impulses of all bands are drawn from for a cubic box; `side` is in length
// units.
double count_cells(const GaborSurfaceNoise& noise, const ArrayView& arrays, double side);

// The number of impulses that the cells around one point hold, in all bands.
double draws_at_a_point(const GaborSurfaceNoise& noise, const ArrayView& arrays);

// The height at a point of the bare surface, length units, from lists of impulses: band b has
// impulses[first[b]] to impulses[first[b + 1] - 1].
ASTROLITH_HD inline float height_at(const GaborSurfaceNoise& n, const ArrayView& arrays,
                                    const GaborImpulse* impulses, const std::uint32_t* first,
                                    const Vec3f& at) {
  const Vec3f p = moved_into(at, n.low, n.high);
  const SurfaceBand* bands = arrays[n.bands];
  float height = 0.0f;
  for (std::uint32_t b = 0; b < n.bands.count; ++b) {
    const float scale = gabor_disc_scale(bands[b].a);
    for (std::uint32_t j = first[b]; j < first[b + 1]; ++j) {
      height = math::fma(bands[b].amplitude, gabor_kernel(impulses[j], scale, p.x, p.y, p.z), height);
    }
  }
  return math::clamp(height, -n.clip, n.clip);
}

// The heights at the four corners p of a small tetrahedron, length units, to first order about its centre.
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
    const float scale = gabor_disc_scale(bands[b].a);
    for (std::uint32_t j = first[b]; j < first[b + 1]; ++j) {
      sum = with_impulse(impulses[j], scale, bands[b].amplitude, q, sum);
    }
  }
  for (int k = 0; k < 4; ++k) {
    heights[k] = height_beside(sum, p[k].x - center.x, p[k].y - center.y, p[k].z - center.z, n.clip);
  }
}

// Writes height[i] = n(p_i) at points of the bare surface. The loop is vectorised and gives the same bits as
// height_at. `caches` has one element for each band.
void evaluate_heights(const GaborSurfaceNoise& noise, const BodyGround& ground, const GaborBrickCache* caches,
                      int n, const float* x, const float* y, const float* z, float* height);

// Writes the heights at the corners of small tetrahedra, to first order about their centres. Points 4 t to 4
// t + 3 are the corners of tetrahedron t. Differences of these heights give gradients; a tetrahedron costs
// about as much as one point.
void evaluate_tetrahedron_heights(const GaborSurfaceNoise& noise, const BodyGround& ground,
                                  const GaborBrickCache* caches, int n, const float* x, const float* y,
                                  const float* z, float* height);

// An interval that holds n(p) for every point, length units. It does not depend on the box.
ASTROLITH_HD inline Interval bound_heights(const GaborSurfaceNoise& n, const ArrayView&, const Box&) {
  return {-n.height_bound, n.height_bound};
}

}  // namespace astrolith
