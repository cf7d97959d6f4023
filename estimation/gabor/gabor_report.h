// Pictures of a fit that a person can judge.
#pragma once

#include <filesystem>
#include <span>

#include "estimation/gabor/gabor_fit.h"
#include "estimation/gabor/grey_image.h"

namespace astrolith {

// Writes into `folder`, which is made if need be: report.png, all of it on one sheet (the exemplar, the
// synthesis, the gap over the iterations, the spectrum estimated from the exemplar, the fitted spectrum, the
// lobes over the estimate), and exemplar.png, synthesis.png, spectrum_exemplar.png and spectrum_fitted.png in
// full resolution. synthesis: heights of the layer at the exemplar's size, row-major, any mean and scale.
// Spectra are logarithmic over six decades, frequency 0 in the middle.
void write_gabor_report(const GreyImage& exemplar, std::span<const float> synthesis, const GaborFit& fit,
                        const std::filesystem::path& folder);

}  // namespace astrolith
