#include "estimation/gabor/fit_memory.h"

#include <algorithm>

#include "estimation/gabor/exemplar/phase_exemplar.h"

namespace astrolith {
namespace {

constexpr double kBytesAnyway = 55e6;         // program, libraries and threads, whatever the image
constexpr double kBytesPerGridPoint = 390.0;  // dictionary, estimates and solver together

// A pixel of a layer's image takes so much: random phases hold spectra of all pixels, exemplars their ranks.
constexpr double kBytesPerImagePixel = 82.0, kBytesPerColorPixel = 150.0;

// The bytes per pixel of the image, at the stage of the fit that holds the most.
double bytes_per_pixel(bool colors, bool report) {
  const double value = 8.0, decoded = 4.0, synthesis = 4.0, pictures = 6.0;
  if (!colors) return value + std::max(decoded, synthesis + (report ? pictures : 0.0));
  const double separating = 2.0 * 3.0 * value + decoded;  // planes and channels side by side
  const double drawing = 3.0 * (3.0 * value + synthesis) + pictures;
  return report ? std::max(separating, drawing) : separating;
}

}  // namespace

double predicted_fit_bytes(const ImageSize& image, const PhotoFitOptions& options, bool report,
                           bool layer_image) {
  const double pixels = static_cast<double>(image.width) * image.height;
  const double grid = static_cast<double>(std::min(image.width, options.fit.largest_side)) *
                      std::min(image.height, options.fit.largest_side);
  const double lobes = kBytesPerGridPoint * grid + bytes_per_pixel(options.colors, report) * pixels,
               layer =
                   layer_image ? pixels * (options.colors ? kBytesPerColorPixel : kBytesPerImagePixel) : 0.0;
  return kBytesAnyway + std::max(lobes, layer);
}

}  // namespace astrolith
