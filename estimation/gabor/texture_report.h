// Pictures and a page from which a person can judge a fit. The pictures can be put in a paper.
#pragma once

#include <cstdint>
#include <filesystem>
#include <span>
#include <string>
#include <vector>

#include "estimation/gabor/gabor_fit.h"
#include "estimation/gabor/image/grey_image.h"
#include "estimation/gabor/model_choice.h"
#include "estimation/gabor/photo_fit.h"
#include "estimation/page/report_page.h"

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

// A photo beside the texture that was fitted to it.
struct TextureReport {
  std::string title;
  ReportPicture photo, texture;     // of one size
  PowerSpectrum measured, shown;    // estimated from the photo, and the texture's, on one grid
  std::string shown_words;          // caption of the spectrum `shown`
  const GaborFit* lobes = nullptr;  // of a texture of lobes
  // A texture with an image has these in place of lobes: the grey values of both, and its image.
  std::vector<double> photo_values, texture_values;
  ReportPicture image;
};

// Writes the pictures of a report into `folder`, which is made if it is missing:
//   report.png, report.svg   one figure (200 pixels an inch) of (a) the photo, (b) the texture, (d) the
//                            spectrum estimated from the photo, (e) the texture's; of lobes (c) the certified
//                            gap of the pursuit against its steps and (f) the lobes over the estimated
//                            spectrum; of an image (c) the distributions of grey values and (f) the image
//   exemplar.png, synthesis.png, spectrum_exemplar.png, spectrum_fitted.png   pictures a, b, d and e in full
// Spectra are logarithmic over six decades, with frequency 0 in the middle. Throws InputError where a file
// cannot be written.
void write_texture_report(const TextureReport& report, const std::filesystem::path& folder);

// The scores of all models, the one that was taken first.
PageTable choice_table(const ModelChoice& choice);
PageTable gaussianity_table(const Gaussianity& gaussianity);
PageTable lobe_table(const FittedChannel& channel);

// Writes index.html into a folder in which write_texture_report has written its figure; the page needs no
// other file. `layer` says what the texture is made of: "lobes", "phase", "exemplar". A relief is as high as
// the picture is bright. Throws InputError where a file cannot be read or written.
void write_texture_page(const TextureReport& report, const std::string& layer, const std::string& verdict,
                        std::vector<PageTable> tables, const std::filesystem::path& folder);

}  // namespace astrolith
