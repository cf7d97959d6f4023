// From an exemplar to a Gabor layer: the whole fit.
#pragma once

#include <cstdint>
#include <vector>

#include "estimation/gabor/image/grey_image.h"
#include "estimation/gabor/pursuit/basis_pursuit.h"
#include "estimation/gabor/spectrum/power_spectrum.h"
#include "estimation/gabor/spectrum/spectrum_estimate.h"
#include "numerics/progress.h"
#include "recipe/recipe.h"

namespace astrolith {

enum class SpectrumTarget {
  kSmoothed,     // smooth estimate, weighted so that errors count as optimal-transport distance
  kPeriodogram,  // the single raw periodogram of the periodic component with equal weights, as in the paper:
                 // fits the exemplar's speckle
};
enum class PursuitSolver { kWorkingSet, kFista };

struct GaborFitOptions {
  SpectrumTarget target = SpectrumTarget::kSmoothed;
  PursuitSolver solver = PursuitSolver::kWorkingSet;
  int max_lobes = 80;           // >= 1
  double penalty_ratio = 0.03;  // penalty over the largest useful one, (0, 1)
  double relative_gap = 1e-4;   // certified at the end of the pursuit
  int largest_side = 1024;      // larger exemplars are averaged over tiles of this side
};

struct GaborFit {
  std::vector<GaborLobe> lobes;  // variances sum to exemplar_rms^2
  double exemplar_mean = 0.0;
  double exemplar_rms = 0.0;             // square root of the periodogram's variance
  PowerSpectrum periodogram;             // of the exemplar
  SpectrumEstimate estimate;             // what was fitted
  PowerSpectrum fitted;                  // of the lobes, on the same grid
  BasisPursuitResult pursuit;            // x left empty: the lobes say it
  int pursuit_lobes = 0;                 // before selection
  double variance_before_scaling = 0.0;  // of the selected lobes over the exemplar's
  double spectrum_distance = 0.0;        // optimal-transport distance of fitted from the estimate
};

// Smallest sides a fit makes sense for.
inline constexpr int kSmallestExemplarSide = 32;

// Throws InputError, naming the exemplar, for sides below 32 pixels and for constant images.
GaborFit fit_gabor_lobes(const GreyImage& exemplar, const std::string& name, const GaborFitOptions& options,
                         const Progress& progress = {});

// The same from a periodogram alone, as of patches that make no whole image; the mean is left 0. Throws
// InputError for sides below 32 and for next to no contrast.
GaborFit fit_gabor_spectrum(PowerSpectrum periodogram, const std::string& name,
                            const GaborFitOptions& options, const Progress& progress = {});

}  // namespace astrolith
