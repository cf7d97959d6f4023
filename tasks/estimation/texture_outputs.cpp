#include "tasks/estimation/fit_gabor.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "estimation/gabor/exemplar/exemplar_preparation.h"
#include "estimation/gabor/spectrum/power_spectrum.h"
#include "estimation/gabor/spectrum/spectrum_estimate.h"
#include "estimation/gabor/texture_report.h"
#include "numerics/sample_statistics.h"
#include "synthesis/exemplar/plane_exemplar.h"
#include "synthesis/gabor/gabor_texture.h"

namespace astrolith {
namespace {

namespace fs = std::filesystem;

// A layer at unit variance and the exemplar's size: for pictures, and to measure what synthesis keeps.
std::vector<float> synthesize_like(const GreyImage& exemplar, GaborLayer layer, std::uint64_t seed,
                                   int stream, const Progress& progress) {
  layer.height_rms = 1.0;
  layer.pixel_size = 1.0;
  return synthesize_texture(layer, exemplar.width, exemplar.height, {seed, stream}, progress);
}

std::uint8_t to_byte(double value) {
  return static_cast<std::uint8_t>(std::lround(255.0 * std::clamp(value, 0.0, 1.0)));
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
    for (const double part : {color.x, color.y, color.z}) picture.rgb.push_back(to_byte(part));
  }
  return picture;
}

// The report of a channel of lobes; the first shows the colours where there are some.
TextureReport lobe_report(const PhotoFit& photo, const FitTexture& texture, std::size_t k) {
  const FittedChannel& channel = photo.channels[k];
  const int width = channel.exemplar.width, height = channel.exemplar.height;
  const GaborFit& fit = channel.fit;
  TextureReport report{{},
                       tone_mapped(channel.exemplar.values, width, height),
                       tone_mapped(texture.channels[k], width, height),
                       fit.estimate.spectrum,
                       fit.fitted,
                       fmt::format("spectrum of the lobes, residual {:.3f}{}", fit.quality.residual,
                                   fit.quality.weak() ? " (weak)" : ""),
                       &fit,
                       {},
                       {},
                       {}};
  if (k == 0 && channel.color) {
    std::vector<ChannelValues> photos, lobes;
    for (std::size_t j = 0; j < photo.channels.size(); ++j) {
      const GaborFit& other = photo.channels[j].fit;
      photos.push_back({photo.channels[j].exemplar.values, other.exemplar_mean, 1.0});
      lobes.push_back({{texture.channels[j].begin(), texture.channels[j].end()}, 0.0, other.exemplar_rms});
    }
    report.photo = color_picture(photo, photos);
    report.texture = color_picture(photo, lobes);
  }
  return report;
}

ReportPicture to_picture(const std::vector<GreyImage>& planes) {
  if (planes.size() == 1) return tone_mapped(planes[0].values, planes[0].width, planes[0].height);
  ReportPicture picture{planes[0].width, planes[0].height, {}};
  for (std::size_t i = 0; i < planes[0].values.size(); ++i) {
    for (const GreyImage& plane : planes) picture.rgb.push_back(to_byte(plane.values[i]));
  }
  return picture;
}

ReportPicture to_picture(const ExemplarImage& image) {
  ReportPicture picture{image.width, image.height, {}};
  constexpr int kBytes = 257;  // 65535 / 255
  for (std::size_t i = 0; i < image.values.size(); ++i) {
    for (std::size_t k = 0; k < 3; ++k) {
      const std::uint16_t value = image.rgb.empty() ? image.values[i] : image.rgb[3 * i + k];
      picture.rgb.push_back(static_cast<std::uint8_t>(value / kBytes));
    }
  }
  return picture;
}

// A report shows no finer frequencies than those of so large a grid.
constexpr int kReportGrid = 512, kSpectrumGrid = 1024;

PowerSpectrum estimated(const GreyImage& image, int grid) {
  return estimate_spectrum(exemplar_periodogram(image, grid)).spectrum;
}

GreyImage texture_image(const TextureFit& fit, const FitTexture& texture) {
  const GreyImage& photo = fit.photo.front();
  return {photo.width, photo.height, {texture.channels.front().begin(), texture.channels.front().end()}};
}

std::string describe_verdict(const TextureFit& fit) {
  if (fit.model != TextureModel::kExemplar) return fit.gaussianity.value().sentence;
  return "The layer is the photo itself, tiled and blended: it keeps the photo's shapes.";
}

std::vector<PageTable> choice_tables(const TextureFit& fit) {
  if (!fit.choice || fit.choice->squares == 0) return {};
  return {choice_table(*fit.choice)};
}

void write_image_report(const std::string& name, const TextureFit& fit, const FitTexture& texture,
                        const fs::path& folder) {
  const GreyImage luma = fit.luma(), image = texture_image(fit, texture);
  const PowerSpectrum measured = estimated(luma, kReportGrid), shown = estimated(image, kReportGrid);
  TextureReport report{
      name,
      to_picture(fit.photo),
      {},
      measured,
      shown,
      fmt::format("spectrum of the texture, {:.3f} from d", optimal_transport_distance(shown, measured)),
      nullptr,
      luma.values,
      image.values,
      to_picture(*fit.image->pixels)};
  report.texture = tone_mapped(image.values, image.width, image.height);
  if (!texture.rgb.empty()) {
    report.texture.rgb.clear();
    for (const float v : texture.rgb) report.texture.rgb.push_back(to_byte(double{v}));
  }
  write_texture_report(report, folder);
  std::vector<PageTable> tables = choice_tables(fit);
  if (fit.gaussianity) tables.push_back(gaussianity_table(*fit.gaussianity));
  write_texture_page(report, std::string(model_word(fit.model)), describe_verdict(fit), std::move(tables),
                     folder);
}

}  // namespace

FitTexture synthesize_like_photo(const TextureFit& fit, const Progress& progress) {
  FitTexture texture;
  if (fit.lobes) {
    for (std::size_t k = 0; k < fit.lobes->channels.size(); ++k) {
      texture.channels.push_back(synthesize_like(fit.lobes->channels[k].exemplar,
                                                 std::get<GaborLayer>(fit.recipe.layers[k]), fit.recipe.seed,
                                                 static_cast<int>(k), progress));
    }
    return texture;
  }
  const GreyImage luma = fit.luma();
  const ExemplarLayer& layer = *fit.image;
  const GreyImage grey = exemplar_texture_like(layer, luma, fit.recipe.seed);
  texture.channels.emplace_back(grey.values.begin(), grey.values.end());
  if (layer.color)
    texture.rgb = synthesize_exemplar_colors(layer, "exemplar", luma.width, luma.height,
                                             {fit.recipe.seed, 0, false}, progress);
  return texture;
}

double synthesized_variance_ratio(const TextureFit& fit, const FitTexture& texture) {
  if (!fit.lobes) return sample_variance(texture.channels.front()) / sample_variance(fit.luma().values);
  double kept = 0.0, variance = 0.0;
  for (std::size_t k = 0; k < fit.lobes->channels.size(); ++k) {
    kept += sample_variance(texture.channels[k]) * fit.lobes->channels[k].variance();
    variance += fit.lobes->channels[k].pixel_variance();
  }
  return kept / variance;
}

void write_texture_reports(const std::string& name, const TextureFit& fit, const FitTexture& texture,
                           const fs::path& folder) {
  if (!fit.lobes) return write_image_report(name, fit, texture, folder);
  const PhotoFit& photo = *fit.lobes;
  for (std::size_t k = 0; k < photo.channels.size(); ++k) {
    const FittedChannel& channel = photo.channels[k];
    const bool alone = photo.channels.size() == 1;
    TextureReport report = lobe_report(photo, texture, k);
    report.title = name + (alone ? "" : fmt::format(", principal channel {}", k + 1));
    const fs::path here = k == 0 ? folder : folder / fmt::format("channel{}", k + 1);
    write_texture_report(report, here);
    std::vector<PageTable> tables = choice_tables(fit);
    tables.push_back(gaussianity_table(channel.gaussianity.value()));
    tables.push_back(lobe_table(channel));
    write_texture_page(report, "lobes", channel.gaussianity->sentence, std::move(tables), here);
  }
}

std::vector<fs::path> texture_report_files(const std::vector<std::string>& folders) {
  std::vector<fs::path> files;
  for (const std::string& folder : folders) {
    for (const char* channel : {"", "channel2", "channel3"}) {
      for (const char* name : {"index.html", "report.png", "report.svg", "exemplar.png", "synthesis.png",
                               "spectrum_exemplar.png", "spectrum_fitted.png"})
        files.push_back(fs::path(folder) / channel / name);
    }
  }
  return files;
}

SpectraArray fitted_spectra(const TextureFit& fit, const FitTexture& texture) {
  if (!fit.lobes) {
    PowerSpectrum shown = estimated(texture_image(fit, texture), kSpectrumGrid);
    return {{shown.height, shown.width}, std::move(shown.power)};
  }
  const std::vector<FittedChannel>& channels = fit.lobes->channels;
  const PowerSpectrum& first = channels.front().fit.fitted;
  SpectraArray spectra{{first.height, first.width}, {}};
  for (const FittedChannel& channel : channels) {
    const std::vector<double>& power = channel.fit.fitted.power;
    spectra.power.insert(spectra.power.end(), power.begin(), power.end());
  }
  if (channels.size() > 1) spectra.shape.insert(spectra.shape.begin(), static_cast<int>(channels.size()));
  return spectra;
}

}  // namespace astrolith
