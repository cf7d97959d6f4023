// Phasor noise (Tricard et al. 2019; thesis eq. 2.27 to 2.30), ready for evaluation over many points.
//
//   height(p) = amplitude profile(phi(p)),      phi(p) = arg sum_j a(|p - p_j|) exp(2 pi i (F u_j.(p - p_j) +
//   psi_j))
// Impulses p_j are as many in each cell of a lattice, uniform in it, with directions u_j about the layer's
// and uniform phases psi_j, so that phi is uniform too. a(d) = (1 - (d / cell)^2)^3, nearly a Gaussian, is 0
// beyond a cell. The profile is a wave of one turn between -1 and 1 with no mean: contrast never fades.
#pragma once

#include <cstdint>

#include "recipe/recipe.h"
#include "synthesis/noise_octaves.h"

namespace astrolith {

class PhasorNoise {
 public:
  // `layer_index` is the layer's number in the recipe: layers of one seed are independent. Points outside
  // `domain`, where no surface is, are moved to its border; beyond 2^20 cells from the origin, where float
  // coordinates could not tell cells apart, there is no noise.
  PhasorNoise(const PhasorLayer& layer, std::uint64_t seed, int layer_index, const Box& domain);

  // height[i] = n(p_i), length units: 0 on average; standard deviation over amplitude 1/sqrt 2 for a sine,
  // 1/sqrt 3 for a triangle and a sawtooth, 1 for a square.
  void evaluate(int n, const float* x, const float* y, const float* z, float* height) const;

  // The phase phi(p_i) in turns, [-1/2, 1/2].
  void evaluate_phase(int n, const float* x, const float* y, const float* z, float* turns) const;

  double height_bound() const { return height_bound_; }
  Interval bound_heights(const Box&) const { return {-height_bound_, height_bound_}; }

 private:
  Vec3f domain_min_, domain_max_, direction_;
  float inverse_cell_, turns_per_cell_, spread_, amplitude_;
  PhasorProfile profile_;
  int impulses_;
  std::uint32_t seed_;
  double height_bound_;
};

}  // namespace astrolith
