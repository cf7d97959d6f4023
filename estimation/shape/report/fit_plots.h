// The plots of a fit's report, and rendered pictures with their captions in a dark strip above them.
#pragma once

#include <filesystem>
#include <span>
#include <string>
#include <vector>

#include "estimation/shape/fit/adaptive_fit.h"
#include "synthesis/picture/image_file.h"

namespace astrolith {

struct CaptionedPicture {
  RgbImage image;
  std::string caption;
};

// The ends of sequential_color, as text: "0" and "0.25 %".
struct ColorScaleLabels {
  std::string low, high;
};

// Writes the pictures side by side as one PNG, pixel by pixel; all have the same height. Throws InputError
// where the file cannot be written.
void write_captioned_pictures(const std::vector<CaptionedPicture>& pictures,
                              const std::filesystem::path& file);

// Writes one picture as PNG, with a bar of sequential_color at the right end of the strip.
void write_picture_with_scale(const CaptionedPicture& picture, const ColorScaleLabels& scale,
                              const std::filesystem::path& file);

// Writes a PNG of the mean distance against the iterations of the refinement. The distance is a percentage of
// the diagonal of the bounding box, on a logarithmic axis. Where the number of metaballs changes, the point
// is labelled with the new number. `points` is not empty. Throws InputError where the file cannot be written.
void write_convergence_plot(std::span<const ConvergencePoint> points, const std::filesystem::path& file);

// Writes a PNG with a histogram of `distances`: signed fractions of the diagonal of the bounding box, at
// points spread evenly over the fit, positive where the fit lies inside the target. The histogram reaches
// from -limit to limit (> 0); its outer bars also count all distances beyond. Throws InputError where the
// file cannot be written.
void write_error_histogram(std::span<const double> distances, double limit,
                           const std::filesystem::path& file);

}  // namespace astrolith
