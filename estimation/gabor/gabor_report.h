// Pictures from which a person can judge a fit, and which can be put in a paper.
#pragma once

#include <cstdint>
#include <filesystem>
#include <span>
#include <string>
#include <vector>

#include "estimation/gabor/gabor_fit.h"
#include "estimation/gabor/image/grey_image.h"

namespace astrolith {

struct ReportPicture {
  int width = 0;
  int height = 0;
  std::vector<std::uint8_t> rgb;  // row-major (height x width x 3)
};

// Grey pictures of width x height values, row-major, of any mean and scale. Black and white lie 3.5 standard
// deviations below and above the mean.
ReportPicture tone_mapped(std::span<const double> values, int width, int height);
ReportPicture tone_mapped(std::span<const float> values, int width, int height);

// Writes the pictures of a fit into `folder`, which is made if it is missing:
//   report.png, report.svg   one figure (200 pixels an inch) of (a) the exemplar, (b) the synthesis, (c) the
//                            certified gap of the pursuit against its steps, (d) the spectrum estimated from
//                            the exemplar, (e) the fitted spectrum and its residual, (f) the lobes over the
//                            estimated spectrum
//   exemplar.png, synthesis.png, spectrum_exemplar.png, spectrum_fitted.png   pictures a, b, d and e in full
// `synthesis` has the size of `exemplar`. Spectra are logarithmic over six decades, with frequency 0 in the
// middle. Throws InputError where a file cannot be written.
void write_gabor_report(const ReportPicture& exemplar, const ReportPicture& synthesis, const GaborFit& fit,
                        const std::string& title, const std::filesystem::path& folder);

}  // namespace astrolith
