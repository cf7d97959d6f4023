// What `evaluation: tiles` of a Gabor layer costs: the power spectrum that its tiles and impulses show.
#pragma once

#include <vector>

#include "estimation/gabor/spectrum/power_spectrum.h"
#include "recipe/recipe.h"

namespace astrolith {

// The correlation of the blending weights of two points of a surface at a distance, in spacings of the
// anchors, averaged over all places and directions: 1 at the same point, below 0.001 and taken as 0
// beyond 1.8 spacings. Blending multiplies the covariance of a tile by it.
class AnchorCorrelation {
 public:
  AnchorCorrelation();
  double at(double distance) const;

 private:
  std::vector<double> values_;
};

// The power per unit of frequency of lobes as impulses, on a width x height grid of frequencies whose first
// is 0. Frequencies above half a cycle per pixel are folded back.
PowerSpectrum lobe_spectrum(const std::vector<GaborLobe>& lobes, int width, int height);

// The power of the same lobes with `evaluation: tiles`, on a flat surface: the lines of the tiles and of
// their interpolation, blurred by the anchors, and the lobes that stay impulses.
PowerSpectrum tiled_spectrum(const std::vector<GaborLobe>& lobes, int width, int height);

// The relative optimal-transport distance of both (spectrum_distance.h).
double tiles_distance(const std::vector<GaborLobe>& lobes, int width, int height);

}  // namespace astrolith
