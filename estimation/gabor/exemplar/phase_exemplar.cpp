#include "estimation/gabor/exemplar/phase_exemplar.h"

#include <algorithm>
#include <cmath>
#include <complex>
#include <cstddef>
#include <limits>
#include <memory>
#include <numbers>
#include <vector>

#include "estimation/gabor/exemplar/exemplar_preparation.h"
#include "estimation/gabor/image/image_channels.h"
#include "estimation/gabor/image/missing_ground.h"
#include "estimation/gabor/spectrum/border_taper.h"
#include "estimation/gabor/spectrum/fourier_transform.h"
#include "estimation/gabor/spectrum/power_spectrum.h"
#include "estimation/gabor/spectrum/tapered_periodogram.h"
#include "numerics/errors.h"
#include "numerics/hash_random.h"
#include "numerics/portable_double.h"
#include "numerics/progress.h"
#include "numerics/sample_statistics.h"
#include "recipe/recipe_json.h"

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

constexpr int kPreferredSide = 1024;

void heed_phases(const Progress& progress, double fraction) {
  if (!report(progress, fraction, "random phases")) throw WorkError("stopped; nothing is written");
}

int image_side(int side, bool repeats) { return repeats ? side : longest_phase_side(side); }

// The wave of random phase at a frequency. Its opposite has the conjugate, and a frequency that is its own
// opposite a random sign.
std::complex<double> random_wave(int kx, int ky, int width, int height, std::uint32_t seed) {
  const int opposite_x = (width - kx) % width, opposite_y = (height - ky) % height;
  const bool mirrored = opposite_y < ky || (opposite_y == ky && opposite_x < kx);
  const auto x = static_cast<std::uint32_t>(mirrored ? opposite_x : kx),
             y = static_cast<std::uint32_t>(mirrored ? opposite_y : ky);
  const double turn = double{unit_float(hash_append(hash_append(seed, y), x))};
  if (opposite_x == kx && opposite_y == ky) return turn < 0.5 ? 1.0 : -1.0;
  const portable::SineCosine angle = portable::sine_and_cosine(2.0 * std::numbers::pi * turn);
  return {angle.cosine, mirrored ? -angle.sine : angle.sine};
}

struct ImageSides {
  int width, height;
};
ImageSides image_sides(const GreyImage& plane) {
  return {image_side(plane.width, repeats_along_x(plane)), image_side(plane.height, repeats_along_y(plane))};
}

// The spectrum of a plane on the frequencies of the layer's image. A photo says nothing of features wider
// than itself, so there is no power below a cycle.
PowerSpectrum plane_spectrum(const GreyImage& plane, const ImageSides& sides) {
  PowerSpectrum spectrum = least_leaky(tapered_power(plane, sides.width, sides.height));
  const double growth =
      std::sqrt(static_cast<double>(sides.width) * sides.height / plane.width / plane.height);
  const std::vector<double> positions = octave_positions(spectrum);
  for (std::size_t i = 0; i < positions.size(); ++i) {
    if (positions[i] < std::log2(growth) - 1e-9) spectrum.power[i] = 0.0;
  }
  return spectrum;
}

GreyImage random_texture(const GreyImage& plane, const ImageSides& sides, std::uint32_t seed,
                         const Progress& progress) {
  heed_phases(progress, 0.0);
  const PowerSpectrum spectrum = plane_spectrum(plane, sides);
  return random_phase_image(spectrum, seed, stretch(progress, 0.5, 1.0));
}

// Red, green and blue: the mean colour and the texture of each principal axis along it.
std::vector<GreyImage> random_phase_colors(const std::vector<GreyImage>& planes, std::uint64_t seed,
                                           const Progress& progress) {
  const std::vector<ImageChannel> channels = principal_channels(planes);
  // All channels get the size of the first, which holds most of the variance.
  const ImageSides sides = image_sides(channels.front().image);
  const Vec3d mean = mean_color(planes);
  const auto pixels = static_cast<std::size_t>(sides.width) * static_cast<std::size_t>(sides.height);
  std::vector<GreyImage> colors;
  for (const double part : {mean.x, mean.y, mean.z})
    colors.push_back({sides.width, sides.height, std::vector<double>(pixels, part)});
  for (std::size_t k = 0; k < channels.size(); ++k) {
    const ImageChannel& c = channels[k];
    const double from = static_cast<double>(k), all = static_cast<double>(channels.size());
    const GreyImage texture = random_texture(c.image, sides, hash_seed(seed, static_cast<std::uint32_t>(k)),
                                             stretch(progress, from / all, (from + 1.0) / all));
    const double axis[] = {c.axis.x, c.axis.y, c.axis.z};
    for (std::size_t i = 0; i < 3 * pixels; ++i)
      colors[i / pixels].values[i % pixels] += axis[i / pixels] * texture.values[i % pixels];
  }
  return colors;
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

int longest_phase_side(int side) { return std::min(4 * side, std::max(side, kPreferredSide)); }

GreyImage random_phase_image(const PowerSpectrum& spectrum, std::uint32_t seed, const Progress& progress) {
  const FourierTransform fourier(spectrum.width, spectrum.height);
  std::vector<std::complex<double>> half(fourier.half_size());
  const auto pixels = static_cast<double>(fourier.grid_size());
  std::size_t i = 0;
  for (int y = 0; y < spectrum.height; ++y) {
    heed_phases(progress, static_cast<double>(y) / spectrum.height);
    for (int x = 0; x < fourier.half_width(); ++x, ++i) {
      const double power =
          spectrum.power[static_cast<std::size_t>(y) * static_cast<std::size_t>(spectrum.width) +
                         static_cast<std::size_t>(x)];
      half[i] = std::sqrt(power * pixels) * random_wave(x, y, spectrum.width, spectrum.height, seed);
    }
  }
  half[0] = 0.0;
  GreyImage image{spectrum.width, spectrum.height, std::vector<double>(fourier.grid_size())};
  fourier.inverse(half, image.values);
  return image;
}

ExemplarLayer phase_exemplar(const std::vector<GreyImage>& planes, const std::string& name,
                             std::uint64_t seed, const Progress& progress) {
  const bool color = planes.size() == 3;
  if (color) require_colors(planes, name);
  const GreyImage photo = color ? luma_image(planes) : planes.front();
  require_exemplar(photo, name);
  const Progress most = stretch(progress, 0.0, 0.9);
  const std::vector<GreyImage> textures =
      color ? random_phase_colors(planes, seed, most)
            : std::vector{random_texture(photo, image_sides(photo), hash_seed(seed, 0), most)};
  heed_phases(progress, 0.9);
  const GreyImage noise = color ? luma_image(textures) : textures.front();
  ExemplarLayer layer;
  layer.pixels =
      std::make_shared<const ExemplarImage>(color ? colors_in_16_bits(textures) : in_16_bits(noise));
  layer.height_rms = round_to_seven_digits(std::sqrt(sample_variance(noise.values)));
  layer.color = color;
  return layer;
}

}  // namespace astrolith
