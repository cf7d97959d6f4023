// A Gabor layer as surface noise on a metaball body, ready for evaluation over many points.
//
// Impulses lie in a grid of cells in space, so many in each cell. Every cell has the tangent frame of the
// body's level set through its centre, and a kernel fades with the distance along its cell's normal
// (gabor_kernel.h): the noise is C1 wherever points move, whatever the frames do from cell to cell. On
// a flat patch it has the spectrum of the lobes, and the layer's variance exactly. First tangent axis: east,
// about +z; second: south, so that a patch seen from outside with north up shows the texture upright.
#pragma once

#include <cstdint>
#include <vector>

#include "recipe/recipe.h"
#include "synthesis/body/combined_body.h"
#include "synthesis/gabor/gabor_surface_points.h"

namespace astrolith {

// Noise and its slope at a point, and what tetrahedra make of them.
ASTROLITH_KERNEL GaborSample with_impulse(const GaborImpulse& impulse, float amplitude, const Vec3f& p,
                                          const GaborSample& sum) {
  const GaborSample k = gabor_kernel_with_slope(impulse, p.x, p.y, p.z);
  return {math::fma(amplitude, k.value, sum.value),
          {math::fma(amplitude, k.slope.x, sum.slope.x), math::fma(amplitude, k.slope.y, sum.slope.y),
           math::fma(amplitude, k.slope.z, sum.slope.z)}};
}
// The centre's coordinate from the four corners'.
ASTROLITH_KERNEL float tetrahedron_center(float a, float b, float c, float d) {
  return 0.25f * ((a + b) + (c + d));
}
// At a corner, to first order about the centre.
ASTROLITH_KERNEL float height_beside(const GaborSample& center, float dx, float dy, float dz, float clip) {
  const float rise = math::fma(dx, center.slope.x, math::fma(dy, center.slope.y, dz * center.slope.z));
  return math::clamp(center.value + rise, -clip, clip);
}

class GaborSurfaceNoise {
 public:
  // Points outside `domain` are moved to its border; bands so fine that float coordinates within it could not
  // tell neighbouring cells apart (above 2^20 cells from the origin) are left out.
  GaborSurfaceNoise(const GaborLayer& layer, std::uint64_t seed, int layer_index, const PreparedBody& body,
                    const Box& domain);

  // height[i] at points *on* the body's surface, in length units, 0 on average, standard deviation
  // layer.height_rms.
  void evaluate(int n, const float* x, const float* y, const float* z, float* height) const;

  // The same at the corners of small tetrahedra, four after four, to first order about their centres: for
  // differences, and about as dear as one point each.
  void evaluate_tetrahedra(int n, const float* x, const float* y, const float* z, float* height) const;

  // 6 times the standard deviation, where heights are cut.
  double height_bound() const { return static_cast<double>(clip_); }

  // What it is made of.
  const SurfaceBand& band(std::size_t number) const { return bands_[number].band(); }
  const Vec3f& domain_min() const { return domain_min_; }
  const Vec3f& domain_max() const { return domain_max_; }
  float clip() const { return clip_; }
  std::size_t num_bands() const { return bands_.size(); }
  float amplitude(std::size_t band) const { return bands_[band].band().amplitude; }
  // The impulses of a band that may reach points of a box, in the order in which they are added.
  std::vector<GaborImpulse> impulses(std::size_t band, const Box& box) const;
  // Cells that those of all bands are drawn from, for a box with sides so long.
  double cells(double side) const;

 private:
  PointBox in_domain(const Box& box) const;
  GaborSurfacePoints add_bands(int n, const float* x, const float* y, const float* z, bool with_slopes) const;

  Vec3f domain_min_, domain_max_;
  std::vector<GaborTiles> bands_;
  float clip_;
};

}  // namespace astrolith
