// Moves and scales lobes to their best fit, and removes lobes that the estimate cannot justify.
#pragma once

#include <span>
#include <vector>

#include "estimation/gabor/lobes/lobe_selection.h"
#include "estimation/gabor/spectrum/power_spectrum.h"
#include "estimation/gabor/spectrum/spectrum_estimate.h"
#include "numerics/progress.h"

namespace astrolith {

// The squared optimal-transport distance, relative to the spectrum's power,
//
//   sum over f != 0 of w(f) (sqrt(S(f) + e(f)) - sqrt(target(f) + e(f)))^2 / sum of w target,
//
// of S = sum_j height_j (g(f - c_j) + g(f + c_j)), with weights w. w e is 1e-6 of the mean of w target and
// keeps the roots smooth. Each lobe has three parameters: the motion of its centre along x and y, in
// deviations of the lobe, and the logarithm of its height over its height at the start. All parameters are 0
// at the start. Bandwidths do not change.
class LobeMisfit {
 public:
  LobeMisfit(std::vector<SpectralLobe> start, const PowerSpectrum& target,
             const std::vector<double>& weights);

  int parameters() const { return 3 * static_cast<int>(start_.size()); }
  // The misfit, and its derivatives by the parameters in `gradient`, which is empty or has as many values as
  // `parameters`. The misfit is infinite where a lobe's centre or height is not finite, so that an optimiser
  // turns back.
  double operator()(std::span<const double> parameters, std::span<double> gradient) const;
  // The lobes that the parameters describe. Centres are wrapped to [-1/2, 1/2) cycles per pixel, since the
  // grid is periodic.
  std::vector<SpectralLobe> lobes_at(std::span<const double> parameters) const;

 private:
  std::vector<SpectralLobe> start_;
  int width_;
  int height_;
  double offset_;                     // w e
  double total_;                      // sum of w target
  std::vector<double> weights_;       // w
  std::vector<double> target_roots_;  // sqrt(w (target + e))
};

struct RefinedLobes {
  std::vector<SpectralLobe> lobes;
  // The refinement ended where no step lowers the misfit further, and not at its largest number of steps.
  bool reached = true;
};

// Moves the centres off the dictionary's lattice and rescales the heights, so that the weighted
// optimal-transport distance from the target (see LobeMisfit) is least. L-BFGS in Ceres minimises it.
// Bandwidths do not change.
//
// The target is the smooth estimate. A refinement by Whittle's likelihood of the periodogram itself was
// tried. It fits speckle: the distance to the truth of the test spectrum grew from 0.094 to 0.137 with 80
// lobes, and to 0.127 with as many lobes as Akaike's criterion keeps.
//
// When progress asks to stop, the lobes are the best so far.
RefinedLobes refine_lobes(const std::vector<SpectralLobe>& lobes, const SpectrumEstimate& target,
                          const Progress& progress = {});

// Refines the lobes. Then it removes those that matter least and refines the others, again and again, as long
// as the weighted distance from the estimate is at most a third of the estimate's own weighted error. Errors
// add in squares, so the removed lobes raise the error by at most one part in twenty. `weight` is that of
// select_lobes. When progress asks to stop, the lobes are the best so far.
RefinedLobes fewest_lobes(const std::vector<SpectralLobe>& lobes, const SpectrumEstimate& estimate,
                          const std::vector<double>& weight, const Progress& progress = {});

}  // namespace astrolith
