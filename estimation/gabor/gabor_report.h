// Pictures of a fit that a person can judge, and put in a paper.
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

// In grey, 3.5 standard deviations on either side of the mean filling the scale; any mean and scale.
ReportPicture tone_mapped(std::span<const double> values, int width, int height);
ReportPicture tone_mapped(std::span<const float> values, int width, int height);

// Writes into `folder`, which is made if need be: the figure report.png (200 pixels an inch) and report.svg,
// with (a) the exemplar, (b) the synthesis of the same size, (c) the certified gap over the steps, (d) the
// spectrum estimated from the exemplar, (e) the fitted spectrum, (f) the lobes over the estimate; and
// exemplar.png, synthesis.png, spectrum_exemplar.png and spectrum_fitted.png pixel by pixel. Spectra are
// logarithmic over six decades, frequency 0 in the middle.
void write_gabor_report(const ReportPicture& exemplar, const ReportPicture& synthesis, const GaborFit& fit,
                        const std::string& title, const std::filesystem::path& folder);

}  // namespace astrolith
