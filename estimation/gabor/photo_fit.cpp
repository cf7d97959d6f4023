#include "estimation/gabor/photo_fit.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "estimation/gabor/exemplar/phase_exemplar.h"
#include "estimation/gabor/image/image_channels.h"
#include "estimation/gabor/image/missing_ground.h"
#include "numerics/errors.h"
#include "numerics/progress.h"
#include "numerics/sample_statistics.h"
#include "recipe/recipe_json.h"

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

PhotoFit grey_channels(GreyImage image) {
  PhotoFit photo;
  photo.channels.emplace_back();
  photo.channels.front().exemplar = std::move(image);
  return photo;
}

Vec3d rounded(const Vec3d& v) {
  return {round_to_seven_digits(v.x), round_to_seven_digits(v.y), round_to_seven_digits(v.z)};
}

PhotoFit color_channels(const std::vector<GreyImage>& planes) {
  PhotoFit photo;
  for (ImageChannel& channel : principal_channels(planes)) {
    const bool first = photo.channels.empty();
    FittedChannel& fitted = photo.channels.emplace_back();
    fitted.exemplar = std::move(channel.image);
    fitted.color = LayerColor{rounded(channel.axis), first ? rounded(mean_color(planes)) : Vec3d{}};
  }
  return photo;
}

// The root of the mean of squares over the channels, weighted by their variances.
template <typename Figure>
double root_mean_square(const std::vector<FittedChannel>& channels, const Figure& figure) {
  double square = 0.0, variance = 0.0;
  for (const FittedChannel& c : channels) {
    square += figure(c) * figure(c) * c.variance();
    variance += c.variance();
  }
  return std::sqrt(square / variance);
}

bool less_plausible(const Gaussianity& a, const Gaussianity& b) {
  return a.likeness != b.likeness ? a.likeness > b.likeness : a.p_value < b.p_value;
}

// The test of an exemplar; none when asked to stop, since the lobes are worth keeping without it.
std::optional<Gaussianity> tested(const GreyImage& exemplar, std::uint64_t seed, const Progress& progress) {
  try {
    return test_gaussianity(exemplar, seed, progress);
  } catch (const WorkError&) {
    return {};
  }
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

std::size_t PhotoFit::lobes() const {
  std::size_t count = 0;
  for (const FittedChannel& c : channels) count += c.fit.lobes.size();
  return count;
}

double FittedChannel::pixel_variance() const { return sample_variance(exemplar.values); }

double PhotoFit::pursuit_gap() const {
  double largest = 0.0;
  for (const FittedChannel& c : channels) largest = std::max(largest, c.fit.pursuit.relative_gap);
  return largest;
}

bool PhotoFit::pursuit_reached() const {
  return std::all_of(channels.begin(), channels.end(),
                     [](const FittedChannel& c) { return c.fit.pursuit.reached; });
}

bool PhotoFit::refinement_reached() const {
  return std::all_of(channels.begin(), channels.end(),
                     [](const FittedChannel& c) { return c.fit.refinement_reached; });
}

// Distances are relative to variances. Squared distances add up over channels, and so do variances.
double PhotoFit::spectrum_distance() const {
  return root_mean_square(channels, [](const FittedChannel& c) { return c.fit.spectrum_distance; });
}

double PhotoFit::spectrum_residual() const {
  return root_mean_square(channels, [](const FittedChannel& c) { return c.fit.quality.residual; });
}

double PhotoFit::weak_above() const {
  return root_mean_square(channels, [](const FittedChannel& c) { return c.fit.quality.weak_above; });
}

double PhotoFit::band_overlap() const {
  double sum = 0.0, variance = 0.0;
  for (const FittedChannel& c : channels) {
    sum += c.fit.quality.band_overlap * c.variance();
    variance += c.variance();
  }
  return sum / variance;
}

bool PhotoFit::weak() const {
  return std::any_of(channels.begin(), channels.end(),
                     [](const FittedChannel& c) { return c.fit.quality.weak(); });
}

double PhotoFit::variance_in_spectrum() const {
  double held = 0.0, variance = 0.0;
  for (const FittedChannel& c : channels) {
    held += c.variance();
    variance += c.pixel_variance();
  }
  return held / variance;
}

std::optional<Gaussianity> PhotoFit::gaussianity() const {
  Gaussianity worst;
  double smallest = 1.0;
  for (const FittedChannel& c : channels) {
    if (!c.gaussianity) return {};
    if (&c == &channels.front() || less_plausible(*c.gaussianity, worst)) worst = *c.gaussianity;
    smallest = std::min(smallest, c.gaussianity->p_value);
  }
  worst.p_value = std::min(1.0, smallest * static_cast<double>(channels.size()));
  return worst;
}

void flatten(std::vector<GreyImage>& planes, const std::string& name, const PhotoFitOptions& options) {
  if (options.detrend_degree == 0) return;
  for (GreyImage& plane : planes) {
    if (std::min(plane.width, plane.height) < kSmallestExemplarSide) continue;
    remove_trend(plane, options.detrend_degree, options.trend, name);
  }
}

PhotoFit fit_planes(std::vector<GreyImage> planes, const std::string& name, const PhotoFitOptions& options,
                    const Progress& progress) {
  PhotoFit photo = planes.size() > 1 ? color_channels(planes) : grey_channels(std::move(planes.front()));
  const auto count = static_cast<double>(photo.channels.size());
  for (std::size_t k = 0; k < photo.channels.size(); ++k) {
    FittedChannel& channel = photo.channels[k];
    const auto share = [&](double done, std::string_view words) {
      return report(progress, (static_cast<double>(k) + done) / count, words);
    };
    constexpr double kFitted = 0.8;
    channel.fit = fit_gabor_lobes(channel.exemplar, name, options.fit, stretch(share, 0.0, kFitted));
    channel.gaussianity = tested(known_texture(channel.exemplar), options.seed, stretch(share, kFitted, 1.0));
  }
  return photo;
}

GaborLayer make_gabor_layer(const FittedChannel& channel, bool first) {
  GaborLayer layer;
  layer.exemplar_mean = channel.fit.exemplar_mean;
  layer.exemplar_rms = channel.fit.exemplar_rms;
  layer.height_rms = first ? channel.fit.exemplar_rms : 0.0;
  layer.color = channel.color;
  layer.lobes = channel.fit.lobes;
  return layer;
}

}  // namespace astrolith
