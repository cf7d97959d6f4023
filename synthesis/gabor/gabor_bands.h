// A Gabor layer's lobes grouped by bandwidth. All lobes of a band share the kernel's envelope and amplitude;
// an impulse draws its lobe with a probability proportional to the lobe's variance.
#pragma once

#include <cstdint>
#include <vector>

#include "recipe/recipe.h"
#include "synthesis/gabor/gabor_draw.h"

namespace astrolith {

struct GaborBand {
  using Lobe = GaborLobeShare;

  int bandwidth = 0;
  double a = 1.0;               // 2^-bandwidth sqrt(pi / (2 ln 2)), cycles per pixel
  double variance_share = 1.0;  // of the layer's variance
  std::vector<Lobe> lobes;

  // The lobe for a uniform number in [0, 1).
  const Lobe& draw(float uniform) const;
};

// Ascending bandwidths; shares add up to 1.
std::vector<GaborBand> gabor_bands(const GaborLayer& layer);

// Heights beyond this many standard deviations are cut: a Gaussian exceeds it once in 5e8 samples, and
// heights need a bound.
inline constexpr double kGaborClip = 6.0;

// The hash from which those of cells follow, then those of the impulses in each.
std::uint32_t gabor_band_seed(std::uint64_t seed, int layer_index, int bandwidth);

}  // namespace astrolith
