#include "estimation/gabor/gaussianity.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <complex>
#include <vector>

#include "estimation/gabor/fourier_transform.h"
#include "estimation/gabor/periodic_component.h"
#include "numerics/hash_random.h"
#include "numerics/parallel_for.h"

namespace astrolith {
namespace {

constexpr int kSurrogates = 99;
constexpr int kLargestSide = 512;
constexpr int kBlocks = 8;

struct Measures {
  double skewness = 0.0;
  double excess_kurtosis = 0.0;
  double variance_spread = 0.0;  // coefficient of variation among blocks
  std::array<double, 3> values() const {
    return {skewness, excess_kurtosis, std::log(variance_spread + 1e-12)};
  }
};

GreyImage central_square(const GreyImage& image) {
  const int width = std::min(image.width, kLargestSide);
  const int height = std::min(image.height, kLargestSide);
  const int x0 = (image.width - width) / 2;
  const int y0 = (image.height - height) / 2;
  GreyImage square{width, height, {}};
  for (int y = y0; y < y0 + height; ++y) {
    for (int x = x0; x < x0 + width; ++x) square.values.push_back(image.at(x, y));
  }
  return square;
}

double block_variance(const GreyImage& image, int bx, int by) {
  double sum = 0.0;
  double square = 0.0;
  int n = 0;
  for (int y = by * image.height / kBlocks; y < (by + 1) * image.height / kBlocks; ++y) {
    for (int x = bx * image.width / kBlocks; x < (bx + 1) * image.width / kBlocks; ++x, ++n) {
      sum += image.at(x, y);
      square += image.at(x, y) * image.at(x, y);
    }
  }
  return std::max(0.0, square / n - sum / n * (sum / n));
}

Measures measure(const GreyImage& image) {
  const auto n = static_cast<double>(image.values.size());
  double mean = 0.0;
  for (const double v : image.values) mean += v / n;
  double moments[3] = {};
  for (const double v : image.values) {
    const double d = v - mean;
    moments[0] += d * d / n;
    moments[1] += d * d * d / n;
    moments[2] += d * d * d * d / n;
  }
  double sum = 0.0;
  double square = 0.0;
  for (int by = 0; by < kBlocks; ++by) {
    for (int bx = 0; bx < kBlocks; ++bx) {
      const double variance = block_variance(image, bx, by);
      sum += variance / (kBlocks * kBlocks);
      square += variance * variance / (kBlocks * kBlocks);
    }
  }
  if (moments[0] <= 0.0 || sum <= 0.0) return {};
  return {moments[1] / std::pow(moments[0], 1.5), moments[2] / (moments[0] * moments[0]) - 3.0,
          std::sqrt(std::max(0.0, square - sum * sum)) / sum};
}

// White noise has independent uniform phases that are already conjugate-symmetric: the surrogate takes them.
GreyImage random_phase_surrogate(const FourierTransform& fourier,
                                 const std::vector<std::complex<double>>& spectrum, std::uint64_t seed,
                                 std::uint64_t index) {
  CounterRandom random(seed, index);
  GreyImage noise{fourier.width(), fourier.height(), std::vector<double>(fourier.grid_size())};
  for (double& v : noise.values) v = random.normal();
  std::vector<std::complex<double>> half(fourier.half_size());
  fourier.forward(noise.values, half);
  half[0] = 0.0;
  for (std::size_t i = 1; i < half.size(); ++i) {
    const double modulus = std::abs(half[i]);
    half[i] = modulus > 0.0 ? half[i] * (std::abs(spectrum[i]) / modulus) : 0.0;
  }
  fourier.inverse(half, noise.values);
  return noise;
}

// How unusual each of the samples is among all: its largest standardised measure.
std::vector<double> unusualness(const std::vector<Measures>& samples) {
  std::vector<double> largest(samples.size(), 0.0);
  const auto n = static_cast<double>(samples.size());
  for (std::size_t k = 0; k < 3; ++k) {
    double mean = 0.0;
    double square = 0.0;
    for (const Measures& m : samples) mean += m.values()[k] / n;
    for (const Measures& m : samples) square += (m.values()[k] - mean) * (m.values()[k] - mean) / n;
    for (std::size_t i = 0; i < samples.size(); ++i) {
      const double deviation = std::abs(samples[i].values()[k] - mean);
      largest[i] = std::max(largest[i], square > 0.0 ? deviation / std::sqrt(square) : 0.0);
    }
  }
  return largest;
}

std::string sentence_for(const Gaussianity& g) {
  if (g.plausible) {
    return g.p_value > 0.05
               ? "The photo is a Gaussian texture as far as can be told: the noise will look like it."
               : "The photo is close to a Gaussian texture: the noise will look much like it.";
  }
  std::string why;
  if (std::abs(g.skewness) > 0.5)
    why += fmt::format(" its values are lopsided (skewness {:.2f});", g.skewness);
  if (std::abs(g.excess_kurtosis) > 1.0) {
    why += fmt::format(" extreme values are {} (excess kurtosis {:.2f});",
                       g.excess_kurtosis > 0.0 ? "common" : "rare", g.excess_kurtosis);
  }
  if (g.variance_spread > 2.0) why += fmt::format(" detail sits in places ({:.1f} x);", g.variance_spread);
  if (why.empty()) why = " its values spread beyond what can be tested;";
  why.back() = '.';
  return "The photo is no Gaussian texture:" + why + " The noise keeps its spectrum, and not its shapes.";
}

}  // namespace

Gaussianity test_gaussianity(const GreyImage& image, std::uint64_t seed) {
  const GreyImage exemplar = decompose_periodic(central_square(image)).periodic;
  const FourierTransform fourier(exemplar.width, exemplar.height);
  std::vector<std::complex<double>> spectrum(fourier.half_size());
  fourier.forward(exemplar.values, spectrum);
  std::vector<Measures> samples(kSurrogates + 1);
  samples[0] = measure(exemplar);
  parallel_for(1, kSurrogates + 1, [&](std::int64_t i) {
    const auto k = static_cast<std::size_t>(i);
    samples[k] = measure(random_phase_surrogate(fourier, spectrum, seed, k));
  });

  Gaussianity result;
  result.skewness = samples[0].skewness;
  result.excess_kurtosis = samples[0].excess_kurtosis;
  double usual_spread = 0.0;
  for (int i = 1; i <= kSurrogates; ++i) usual_spread += samples[static_cast<std::size_t>(i)].variance_spread;
  usual_spread /= kSurrogates;
  result.variance_spread = usual_spread > 0.0 ? samples[0].variance_spread / usual_spread : 1.0;
  const std::vector<double> unusual = unusualness(samples);
  const auto as_unusual =
      std::count_if(unusual.begin(), unusual.end(), [&](double u) { return u >= unusual[0]; });
  result.p_value = static_cast<double>(as_unusual) / (kSurrogates + 1);
  result.plausible = std::abs(result.skewness) <= 0.5 && std::abs(result.excess_kurtosis) <= 1.0 &&
                     result.variance_spread <= 2.0;
  result.sentence = sentence_for(result);
  return result;
}

}  // namespace astrolith
