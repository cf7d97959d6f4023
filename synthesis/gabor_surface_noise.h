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
#include "synthesis/combined_body.h"
#include "synthesis/gabor_surface_points.h"

namespace astrolith {

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

 private:
  GaborSurfacePoints add_bands(int n, const float* x, const float* y, const float* z, bool with_slopes) const;

  Vec3f domain_min_, domain_max_;
  std::vector<GaborTiles> bands_;
  float clip_;
};

}  // namespace astrolith
