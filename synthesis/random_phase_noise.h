// Local random phase noise (Gilet et al. 2014; thesis eq. 2.25), ready for evaluation over many points.
//
//   n(p) = rms / norm(p) sum_i w_i(p) sum_j A_j cos(2 pi f_j.p + phi_ij)
// with i over the eight lattice points around p. Each window w_i is a product of cos(pi/2 fade(t)) along the
// axes, t in cells: its squares add up to 1 over the lattice, so that waves of independent phases have the
// same variance everywhere. Phases that the cells share in part add up coherently; norm(p) makes up for it:
//   norm^2 = (1 - c) + c (sum_i w_i)^2,      c = (sin(pi r) / (pi r))^2,     r the layer's randomness.
#pragma once

#include <cstdint>
#include <vector>

#include "recipe/recipe.h"
#include "synthesis/noise_octaves.h"

namespace astrolith {

// One wave: turns at p are frequency . p + phase.
struct Wave {
  Vec3f frequency;
  float phase;
  float amplitude;  // length units
  std::uint32_t seed;
};

class RandomPhaseNoise {
 public:
  // `layer_index` is the layer's number in the recipe: layers of one seed are independent. Points outside
  // `domain`, where no surface is, are moved to its border; waves of more than 2^18 turns within it, whose
  // phases float coordinates could not hold, are left out.
  RandomPhaseNoise(const RandomPhaseLayer& layer, std::uint64_t seed, int layer_index, const Box& domain);

  // height[i] = n(p_i), length units: 0 on average, standard deviation height_rms over seeds.
  void evaluate(int n, const float* x, const float* y, const float* z, float* height) const;

  // 6 times the standard deviation, where heights are cut.
  double height_bound() const { return static_cast<double>(clip_); }
  Interval bound_heights(const Box&) const { return {-height_bound(), height_bound()}; }

  const std::vector<Wave>& waves() const { return waves_; }

 private:
  void evaluate_chunk(int n, const float* x, const float* y, const float* z, float* height) const;

  std::vector<Wave> waves_;
  Vec3f domain_min_, domain_max_;
  float inverse_cell_, randomness_, coherence_, clip_;
  std::uint32_t seed_;
};

}  // namespace astrolith
