#include "estimation/gabor/exemplar/completed_image.h"

#include <algorithm>
#include <cstddef>
#include <limits>
#include <vector>

#include "estimation/gabor/exemplar/phase_exemplar.h"
#include "estimation/gabor/image/missing_ground.h"
#include "estimation/gabor/spectrum/border_taper.h"
#include "estimation/gabor/spectrum/power_spectrum.h"
#include "estimation/gabor/spectrum/spectrum_distance.h"
#include "numerics/hash_random.h"

namespace astrolith {
namespace {

// What the spectrum lacks in power falls in each turn by the share of missing pixels.
constexpr int kTurns = 3;
// Larger images get noise that repeats after this many pixels.
constexpr int kNoiseSide = 1024;
// A small image with a large gap has one among several draws, whose pixels are this many at most together.
constexpr int kDrawnPixels = 8 << 20, kMostDraws = 16;

// The values that continue `pixel(i)` of the known pixels smoothly, at the missing ones in their order.
template <typename Pixel>
std::vector<double> continued(const GreyImage& image, const Repeats& repeats, const Pixel& pixel) {
  GreyImage filled{image.width, image.height, {}};
  filled.values.reserve(image.values.size());
  for (std::size_t i = 0; i < image.values.size(); ++i)
    filled.values.push_back(image.missing[i] ? std::numeric_limits<double>::quiet_NaN() : pixel(i));
  fill_missing(filled, repeats);
  std::vector<double> values;
  for (std::size_t i = 0; i < image.values.size(); ++i) {
    if (image.missing[i]) values.push_back(filled.values[i]);
  }
  return values;
}

// The spectrum that is nearest to the mean of all.
std::size_t most_usual(const std::vector<PowerSpectrum>& spectra) {
  PowerSpectrum mean = spectra.front();
  for (std::size_t i = 0; i < mean.power.size(); ++i) {
    double sum = 0.0;
    for (const PowerSpectrum& s : spectra) sum += s.power[i];
    mean.power[i] = sum / static_cast<double>(spectra.size());
  }
  std::vector<double> distances;
  for (const PowerSpectrum& s : spectra) distances.push_back(optimal_transport_distance(s, mean));
  return static_cast<std::size_t>(std::min_element(distances.begin(), distances.end()) - distances.begin());
}

}  // namespace

GreyImage completed(GreyImage image, std::uint64_t seed, const Progress& progress) {
  if (image.missing.empty()) return image;
  const Repeats repeats{repeats_along_x(image), repeats_along_y(image)};
  const std::vector<double> smooth =
      continued(image, repeats, [&](std::size_t i) { return image.values[i]; });
  const auto width = static_cast<std::size_t>(image.width);
  const auto draw = [&](const PowerSpectrum& spectrum, std::uint32_t number) {
    const GreyImage noise = random_phase_image(spectrum, hash_seed(seed, number));
    const auto noise_at = [&](std::size_t i) {
      return noise.at(static_cast<int>(i % width) % noise.width, static_cast<int>(i / width) % noise.height);
    };
    const std::vector<double> explained = continued(image, repeats, noise_at);
    for (std::size_t i = 0, k = 0; i < image.values.size(); ++i) {
      if (!image.missing[i]) continue;
      image.values[i] = smooth[k] + noise_at(i) - explained[k];
      ++k;
    }
    return exemplar_periodogram(image, kNoiseSide, progress);
  };
  PowerSpectrum spectrum = exemplar_periodogram(image, kNoiseSide, progress);
  for (std::uint32_t turn = 1; turn < kTurns; ++turn) spectrum = draw(spectrum, turn);
  const auto draws = std::clamp(kDrawnPixels / static_cast<int>(image.values.size()), 1, kMostDraws);
  std::vector<PowerSpectrum> drawn;
  for (int k = 0; k < draws; ++k) drawn.push_back(draw(spectrum, kTurns + static_cast<std::uint32_t>(k)));
  draw(spectrum, kTurns + static_cast<std::uint32_t>(most_usual(drawn)));
  return image;
}

}  // namespace astrolith
