// Coordinates displaced by fractal noise (thesis eq. 4.6), ready for evaluation over many points.
#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "recipe/recipe.h"
#include "synthesis/noise/noise_octaves.h"

namespace astrolith {

class CoordinateWarp {
 public:
  // `seed` is of what the warp belongs to; its noises are independent of that one's own. Displaced points of
  // interest lie in `domain`. Octaves too fine for float coordinates of points that may come to lie there are
  // left out; points still farther are displaced as the nearest of those.
  CoordinateWarp(const Warp& warp, std::uint32_t seed, const Box& domain);

  // (wx, wy, wz)[i] = p_i + warp(p_i); the outputs overlap nothing.
  void evaluate(int n, const float* x, const float* y, const float* z, float* wx, float* wy, float* wz) const;

  // No coordinate is displaced by more, in length units.
  double bound() const { return bound_; }
  // |p + warp(p) - q - warp(q)| <= stretch |p - q|, in exact arithmetic.
  double lipschitz_bound() const { return lipschitz_bound_; }

  // Holds p + warp(p) for every float point p of a box.
  Box image(const Box& box) const;

  // Of the simplex noise that displaces along an axis.
  const std::vector<NoiseOctave>& octaves(std::size_t axis) const { return octaves_[axis]; }
  // Points outside are displaced as the nearest one inside.
  const Vec3f& domain_min() const { return domain_min_; }
  const Vec3f& domain_max() const { return domain_max_; }

 private:
  std::array<std::vector<NoiseOctave>, 3> octaves_;  // of the displacement along x, y, z
  Vec3f domain_min_, domain_max_;
  double bound_, lipschitz_bound_;
};

}  // namespace astrolith
