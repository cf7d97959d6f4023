#include "estimation/gabor/photo_fit.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "estimation/gabor/image/image_channels.h"
#include "estimation/gabor/image/image_reader.h"
#include "recipe/recipe_json.h"

namespace astrolith {
namespace {

void detrend(GreyImage& image, const std::string& name, const PhotoFitOptions& options) {
  // The fit refuses smaller images with a better message than remove_trend has.
  if (options.detrend_degree == 0 || std::min(image.width, image.height) < kSmallestExemplarSide) return;
  remove_trend(image, options.detrend_degree, options.trend, name);
}

PhotoFit grey_channels(const std::filesystem::path& file, const PhotoFitOptions& options) {
  PhotoFit photo;
  ImageFile read = read_grey_image(file);
  detrend(read.image, file.string(), options);
  photo.remarks = std::move(read.remarks);
  photo.channels.emplace_back();
  photo.channels.front().exemplar = std::move(read.image);
  return photo;
}

Vec3d rounded(const Vec3d& v) {
  return {round_to_seven_digits(v.x), round_to_seven_digits(v.y), round_to_seven_digits(v.z)};
}

PhotoFit color_channels(const std::filesystem::path& file, const PhotoFitOptions& options) {
  PhotoFit photo;
  ColorImageFile read = read_color_image(file);
  for (GreyImage& plane : read.planes) detrend(plane, file.string(), options);
  photo.remarks = std::move(read.remarks);
  for (ImageChannel& channel : principal_channels(read.planes)) {
    const bool first = photo.channels.empty();
    FittedChannel& fitted = photo.channels.emplace_back();
    fitted.exemplar = std::move(channel.image);
    fitted.color = LayerColor{rounded(channel.axis), first ? rounded(mean_color(read.planes)) : Vec3d{}};
  }
  return photo;
}

}  // namespace

std::size_t PhotoFit::lobes() const {
  std::size_t count = 0;
  for (const FittedChannel& c : channels) count += c.fit.lobes.size();
  return count;
}

double PhotoFit::relative_gap() const {
  double largest = 0.0;
  for (const FittedChannel& c : channels) largest = std::max(largest, c.fit.pursuit.relative_gap);
  return largest;
}

// Distances are relative to variances. Squared distances add up over channels, and so do variances.
double PhotoFit::spectrum_distance() const {
  double square = 0.0, variance = 0.0;
  for (const FittedChannel& c : channels) {
    square += c.fit.spectrum_distance * c.fit.spectrum_distance * c.variance();
    variance += c.variance();
  }
  return std::sqrt(square / variance);
}

double PhotoFit::variance_ratio() const {
  double fitted = 0.0, variance = 0.0;
  for (const FittedChannel& c : channels) {
    for (const GaborLobe& lobe : c.fit.lobes) fitted += lobe.variance;
    variance += c.variance();
  }
  return fitted / variance;
}

Gaussianity PhotoFit::gaussianity() const {
  const auto less_plausible = [](const FittedChannel& a, const FittedChannel& b) {
    if (a.gaussianity.likeness != b.gaussianity.likeness)
      return a.gaussianity.likeness > b.gaussianity.likeness;
    return a.gaussianity.p_value < b.gaussianity.p_value;
  };
  Gaussianity worst = std::min_element(channels.begin(), channels.end(), less_plausible)->gaussianity;
  double smallest = 1.0;
  for (const FittedChannel& c : channels) smallest = std::min(smallest, c.gaussianity.p_value);
  worst.p_value = std::min(1.0, smallest * static_cast<double>(channels.size()));
  return worst;
}

PhotoFit fit_photo(const std::filesystem::path& file, const PhotoFitOptions& options,
                   const Progress& progress) {
  PhotoFit photo = options.colors ? color_channels(file, options) : grey_channels(file, options);
  const auto count = static_cast<double>(photo.channels.size());
  for (std::size_t k = 0; k < photo.channels.size(); ++k) {
    FittedChannel& channel = photo.channels[k];
    const auto share = [&](double done, std::string_view words) {
      return report(progress, (static_cast<double>(k) + done) / count, words);
    };
    channel.fit = fit_gabor_lobes(channel.exemplar, file.string(), options.fit, share);
    channel.gaussianity = test_gaussianity(channel.exemplar, options.seed);
  }
  return photo;
}

GaborLayer layer_of(const FittedChannel& channel, bool first) {
  GaborLayer layer;
  layer.exemplar_mean = channel.fit.exemplar_mean;
  layer.exemplar_rms = channel.fit.exemplar_rms;
  layer.height_rms = first ? channel.fit.exemplar_rms : 0.0;
  layer.color = channel.color;
  layer.lobes = channel.fit.lobes;
  return layer;
}

}  // namespace astrolith
