#include "estimation/gabor/exemplar/phase_exemplar.h"

#include <algorithm>
#include <cmath>
#include <complex>
#include <memory>
#include <numbers>

#include "estimation/gabor/exemplar/exemplar_pixels.h"
#include "estimation/gabor/image/image_channels.h"
#include "estimation/gabor/spectrum/border_taper.h"
#include "estimation/gabor/spectrum/fourier_transform.h"
#include "estimation/gabor/spectrum/octaves.h"
#include "estimation/gabor/spectrum/tapered_periodogram.h"
#include "numerics/errors.h"
#include "numerics/hash_random.h"
#include "numerics/portable_double.h"
#include "numerics/progress_stretch.h"
#include "numerics/sample_statistics.h"
#include "recipe/recipe_json.h"

namespace astrolith {
namespace {

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
PowerSpectrum spectrum_of_plane(const GreyImage& plane, const ImageSides& sides) {
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
  const PowerSpectrum spectrum = spectrum_of_plane(plane, sides);
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
  const GreyImage photo = color ? luma_of(planes) : planes.front();
  require_exemplar(photo, name);
  const Progress most = stretch(progress, 0.0, 0.9);
  const std::vector<GreyImage> textures =
      color ? random_phase_colors(planes, seed, most)
            : std::vector{random_texture(photo, image_sides(photo), hash_seed(seed, 0), most)};
  heed_phases(progress, 0.9);
  const GreyImage noise = color ? luma_of(textures) : textures.front();
  ExemplarLayer layer;
  layer.pixels =
      std::make_shared<const ExemplarImage>(color ? colors_in_16_bits(textures) : in_16_bits(noise));
  layer.height_rms = round_to_seven_digits(std::sqrt(variance_of(noise.values)));
  layer.color = color;
  return layer;
}

}  // namespace astrolith
