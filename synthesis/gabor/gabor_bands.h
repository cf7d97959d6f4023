// The lobes of a Gabor layer, grouped by bandwidth. All lobes of a band share the envelope and the amplitude
// of the kernel. An impulse draws its lobe with a probability proportional to the variance of the lobe.
#pragma once

#include <cstdint>
#include <vector>

#include "recipe/recipe.h"
#include "synthesis/gabor/gabor_draw.h"

namespace astrolith {

// The lobes of one bandwidth.
struct GaborBand {
  using Lobe = GaborLobeShare;

  int bandwidth = 0;
  double a = 1.0;               // 2^-bandwidth sqrt(pi / (2 ln 2)), cycles per pixel
  double variance_share = 1.0;  // share of this band in the variance of the layer
  std::vector<Lobe> lobes;

  // The lobe that a uniform number in [0, 1) selects.
  const Lobe& draw(float uniform) const;
};

// The bands of a layer in the order of ascending bandwidths. Their variance shares add up to 1. Lobes without
// variance are left out.
std::vector<GaborBand> gabor_bands(const GaborLayer& layer);

// Heights are clamped to this many standard deviations, since they need a bound. A Gaussian exceeds it once
// in 5e8 samples.
inline constexpr double kGaborClip = 6.0;

// The seed of a band. The hashes of its cells follow from it, and from these the hashes of the impulses.
std::uint32_t gabor_band_seed(std::uint64_t seed, int layer_index, int bandwidth);

}  // namespace astrolith
