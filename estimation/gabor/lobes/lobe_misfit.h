// How far a sum of lobes is from a spectrum, as a function of where the lobes are and how high.
#pragma once

#include <span>
#include <vector>

#include "estimation/gabor/lobes/lobe_selection.h"
#include "estimation/gabor/spectrum/power_spectrum.h"

namespace astrolith {

// The squared optimal-transport distance, relative to the spectrum's power,
//
//   sum over f != 0 of (sqrt(S(f) + e) - sqrt(target(f) + e))^2 / sum of target,
//
// of S = sum_j height_j (g(f - c_j) + g(f + c_j)), e = 1e-6 of the mean power, which keeps the roots smooth.
// Three parameters a lobe: how far the centre has moved along x and y, in deviations of the lobe, and the
// logarithm of height over the height at the start. All are 0 at the start; bandwidths stay.
class LobeMisfit {
 public:
  LobeMisfit(std::vector<SpectralLobe> start, const PowerSpectrum& target);

  int parameters() const { return 3 * static_cast<int>(start_.size()); }
  // `gradient`: empty, or as many values as there are parameters. Infinite where a lobe has no finite place
  // or height: an optimiser that strays there turns back.
  double operator()(std::span<const double> parameters, std::span<double> gradient) const;
  // Centres are brought back to [-1/2, 1/2): the grid is periodic.
  std::vector<SpectralLobe> lobes_at(std::span<const double> parameters) const;

 private:
  std::vector<SpectralLobe> start_;
  int width_;
  int height_;
  double offset_;                     // e
  double total_;                      // sum of target
  std::vector<double> target_roots_;  // sqrt(target + e)
};

}  // namespace astrolith
