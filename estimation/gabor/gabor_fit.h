// Fits a Gabor layer to an exemplar.
#pragma once

#include <cstdint>
#include <vector>

#include "estimation/gabor/image/grey_image.h"
#include "estimation/gabor/lobes/lobe_quality.h"
#include "estimation/gabor/pursuit/basis_pursuit.h"
#include "estimation/gabor/spectrum/power_spectrum.h"
#include "estimation/gabor/spectrum/spectrum_estimate.h"
#include "numerics/progress.h"
#include "recipe/recipe.h"

namespace astrolith {

struct GaborFitOptions {
  int max_lobes = 80;           // >= 1
  double penalty_ratio = 0.03;  // penalty over the largest useful one, (0, 1)
  double relative_gap = 1e-4;   // certified at the end of the pursuit
  int largest_side = 1024;      // larger exemplars are averaged over segments of this side
};

struct GaborFit {
  std::vector<GaborLobe> lobes;  // variances sum to exemplar_rms^2
  double exemplar_mean = 0.0;
  double exemplar_rms = 0.0;             // square root of the periodogram's variance
  PowerSpectrum periodogram;             // spectrum of the exemplar
  SpectrumEstimate estimate;             // the spectrum to which the lobes were fitted
  PowerSpectrum fitted;                  // spectrum of the lobes, on the grid of the estimate
  BasisPursuitResult pursuit;            // its x is empty
  int pursuit_lobes = 0;                 // number of lobes before selection
  double variance_before_scaling = 0.0;  // variance of the selected lobes over that of the exemplar
  bool refinement_reached = true;        // RefinedLobes::reached; true where there is no refinement
  double spectrum_distance = 0.0;        // optimal-transport distance of `fitted` from the estimate
  LobeQuality quality;                   // of `fitted` beside the periodogram
};

// The smallest side of an exemplar, in pixels.
inline constexpr int kSmallestExemplarSide = 32;

// The smallest share of an exemplar's variance that its spectrum holds. Below it there is no texture.
inline constexpr double kLeastTexture = 1e-6;

// Fits lobes to an exemplar, which messages call `name`. Throws InputError for sides below 32 pixels and for
// constant images and those without texture or a lobe that fits, WorkError when progress asks to stop early.
GaborFit fit_gabor_lobes(const GreyImage& exemplar, const std::string& name, const GaborFitOptions& options,
                         const Progress& progress = {});

// Fits lobes to a periodogram, for patches that do not make a whole image; exemplar_mean stays 0. Throws
// InputError for sides below 32 pixels and for a standard deviation of at most 1e-4.
GaborFit fit_gabor_spectrum(PowerSpectrum periodogram, const std::string& name,
                            const GaborFitOptions& options, const Progress& progress = {});

}  // namespace astrolith
