#include "tasks/estimation/photo_outputs.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "estimation/gabor/gabor_page.h"
#include "estimation/gabor/gabor_report.h"
#include "numerics/files/npy_file.h"
#include "numerics/sample_statistics.h"
#include "synthesis/gabor/gabor_texture.h"

namespace astrolith {
namespace {

// A layer at unit variance and the exemplar's size: for pictures, and to measure what synthesis keeps.
std::vector<float> synthesize_like(const GreyImage& exemplar, GaborLayer layer, std::uint64_t seed,
                                   int stream, const Progress& progress) {
  layer.height_rms = 1.0;
  layer.pixel_size = 1.0;
  return synthesize_texture(layer, exemplar.width, exemplar.height, {seed, stream}, progress);
}

// The channels put together again: mean + sum of axis * gain * (values - center), cut to full scale.
struct ChannelValues {
  std::vector<double> values;
  double center, gain;
};

ReportPicture color_picture(const PhotoFit& photo, const std::vector<ChannelValues>& channels) {
  const GreyImage& size = photo.channels.front().exemplar;
  const Vec3d mean = photo.channels.front().color->mean;
  ReportPicture picture{size.width, size.height, {}};
  picture.rgb.reserve(3 * size.values.size());
  for (std::size_t i = 0; i < size.values.size(); ++i) {
    Vec3d color = mean;
    for (std::size_t k = 0; k < channels.size(); ++k) {
      const ChannelValues& c = channels[k];
      color = color + photo.channels[k].color->axis * (c.gain * (c.values[i] - c.center));
    }
    for (const double part : {color.x, color.y, color.z})
      picture.rgb.push_back(static_cast<std::uint8_t>(std::lround(255.0 * std::clamp(part, 0.0, 1.0))));
  }
  return picture;
}

}  // namespace

std::vector<std::vector<float>> synthesize_channels(const PhotoFit& photo, const Recipe& recipe,
                                                    const Progress& progress) {
  std::vector<std::vector<float>> syntheses;
  for (std::size_t k = 0; k < photo.channels.size(); ++k) {
    syntheses.push_back(synthesize_like(photo.channels[k].exemplar, std::get<GaborLayer>(recipe.layers[k]),
                                        recipe.seed, static_cast<int>(k), progress));
  }
  return syntheses;
}

double synthesized_variance_ratio(const PhotoFit& photo, const std::vector<std::vector<float>>& syntheses) {
  double kept = 0.0, variance = 0.0;
  for (std::size_t k = 0; k < photo.channels.size(); ++k) {
    kept += variance_of(syntheses[k]) * photo.channels[k].variance();
    variance += photo.channels[k].pixel_variance();
  }
  return kept / variance;
}

// One figure a channel; the first shows the colours where there are some.
void write_reports(const std::filesystem::path& image, const PhotoFit& photo,
                   const std::vector<std::vector<float>>& syntheses, const std::filesystem::path& folder) {
  for (std::size_t k = 0; k < photo.channels.size(); ++k) {
    const FittedChannel& channel = photo.channels[k];
    const int width = channel.exemplar.width, height = channel.exemplar.height;
    ReportPicture exemplar = tone_mapped(channel.exemplar.values, width, height);
    ReportPicture synthesis = tone_mapped(syntheses[k], width, height);
    if (k == 0 && channel.color) {
      std::vector<ChannelValues> photos, noises;
      for (std::size_t j = 0; j < photo.channels.size(); ++j) {
        const GaborFit& fit = photo.channels[j].fit;
        photos.push_back({photo.channels[j].exemplar.values, fit.exemplar_mean, 1.0});
        noises.push_back({{syntheses[j].begin(), syntheses[j].end()}, 0.0, fit.exemplar_rms});
      }
      exemplar = color_picture(photo, photos);
      synthesis = color_picture(photo, noises);
    }
    const bool alone = photo.channels.size() == 1;
    const std::string title =
        image.filename().string() + (alone ? "" : fmt::format(", principal channel {}", k + 1));
    const std::filesystem::path here = k == 0 ? folder : folder / fmt::format("channel{}", k + 1);
    write_gabor_report(exemplar, synthesis, channel.fit, title, here);
    write_gabor_page(exemplar, synthesis, channel, title, here);
  }
}

SpectraArray fitted_spectra(const PhotoFit& photo) {
  const PowerSpectrum& first = photo.channels.front().fit.fitted;
  SpectraArray spectra{{first.height, first.width}, {}};
  for (const FittedChannel& channel : photo.channels) {
    const std::vector<double>& power = channel.fit.fitted.power;
    spectra.power.insert(spectra.power.end(), power.begin(), power.end());
  }
  if (photo.channels.size() > 1) {
    spectra.shape.insert(spectra.shape.begin(), static_cast<int>(photo.channels.size()));
  }
  return spectra;
}

void write_spectra(const PhotoFit& photo, const std::filesystem::path& file) {
  const SpectraArray spectra = fitted_spectra(photo);
  write_npy(spectra.power, spectra.shape, file);
}

}  // namespace astrolith
