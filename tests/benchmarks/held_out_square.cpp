#include "tests/benchmarks/held_out_square.h"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <complex>
#include <numbers>

#include "estimation/gabor/spectrum/fourier_transform.h"
#include "estimation/gabor/spectrum/periodic_component.h"
#include "estimation/gabor/spectrum/spectrum_distance.h"
#include "numerics/errors.h"
#include "numerics/hash_random.h"
#include "recipe/recipe_json.h"
#include "synthesis/gabor/gabor_texture.h"

namespace astrolith::testing {
namespace {

constexpr int kWindow = 64;

double mean_of(const std::vector<double>& values) {
  double sum = 0.0;
  for (const double v : values) sum += v;
  return sum / static_cast<double>(values.size());
}

double variance_of(const std::vector<double>& values) {
  const double mean = mean_of(values);
  double sum = 0.0;
  for (const double v : values) sum += (v - mean) * (v - mean);
  return sum / static_cast<double>(values.size());
}

double hann(int i) { return 0.5 - 0.5 * std::cos(2.0 * std::numbers::pi * i / kWindow); }

GreyImage synthesis_of(const GaborFit& fit, int side, std::uint64_t seed) {
  GaborLayer layer;
  layer.height_rms = fit.exemplar_rms;
  layer.lobes = fit.lobes;
  const std::vector<float> texture = synthesize_texture(layer, side, side, {.seed = seed});
  return {side, side, std::vector<double>(texture.begin(), texture.end())};
}

std::size_t recipe_size(const GaborFit& fit) {
  GaborLayer layer;
  layer.name = "layer";
  layer.exemplar_mean = fit.exemplar_mean;
  layer.exemplar_rms = layer.height_rms = fit.exemplar_rms;
  layer.lobes = fit.lobes;
  Recipe recipe;
  recipe.length_unit = "px";
  recipe.layers.push_back(layer);
  return recipe_to_json(recipe).size();
}

}  // namespace

PowerSpectrum welch_spectrum(const GreyImage& image) {
  PowerSpectrum sum{kWindow, kWindow, std::vector<double>(kWindow * kWindow, 0.0)};
  const double mean = mean_of(image.values);
  for (int y0 = 0; y0 + kWindow <= image.height; y0 += kWindow / 2) {
    for (int x0 = 0; x0 + kWindow <= image.width; x0 += kWindow / 2) {
      GreyImage window{kWindow, kWindow, {}};
      for (int y = 0; y < kWindow; ++y) {
        for (int x = 0; x < kWindow; ++x) {
          window.values.push_back(hann(x) * hann(y) * (image.at(x0 + x, y0 + y) - mean));
        }
      }
      const PowerSpectrum one = power_spectrum(window);
      for (std::size_t i = 1; i < sum.power.size(); ++i) sum.power[i] += one.power[i];
    }
  }
  const double variance = sum.variance();
  for (double& p : sum.power) p /= variance;
  return sum;
}

// E |DFT of window * texture|^2 is the Fourier transform of the autocovariance times the autocorrelation of
// the window. Its lags reach 64, so that every 256/64-th frequency of it is a Welch frequency.
PowerSpectrum expected_welch_spectrum(const PowerSpectrum& spectrum) {
  const int w = spectrum.width;
  const int h = spectrum.height;
  const FourierTransform fourier(w, h);
  std::vector<double> autocovariance(fourier.grid_size());
  std::vector<double> window(fourier.grid_size(), 0.0);
  for (int y = 0; y < kWindow; ++y) {
    for (int x = 0; x < kWindow; ++x) window[static_cast<std::size_t>(y * w + x)] = hann(x) * hann(y);
  }
  std::vector<std::complex<double>> half(fourier.half_size());
  const auto squared_modulus_back = [&](std::vector<double>& grid) {
    fourier.forward(grid, half);
    for (std::complex<double>& c : half) c = std::norm(c);
    fourier.inverse(half, grid);
  };
  squared_modulus_back(window);
  // A spectrum is real and even, so that its inverse transform is its transform.
  fourier.forward(spectrum.power, half);
  std::vector<std::complex<double>> lags = half;
  for (int y = 0; y < h; ++y) {
    for (int x = 0; x < fourier.half_width(); ++x) {
      const auto i = static_cast<std::size_t>(y * fourier.half_width() + x);
      lags[i] = half[i].real() * window[static_cast<std::size_t>(y * w + x)];
    }
  }
  fourier.inverse(lags, autocovariance);
  PowerSpectrum result{kWindow, kWindow, {}};
  for (int y = 0; y < kWindow; ++y) {
    for (int x = 0; x < kWindow; ++x) {
      const int i = y * (h / kWindow) * w + x * (w / kWindow);
      result.power.push_back(std::max(0.0, autocovariance[static_cast<std::size_t>(i)]));
    }
  }
  result.power[0] = 0.0;
  const double variance = result.variance();
  for (double& p : result.power) p /= variance;
  return result;
}

GreyImage random_phase_noise(const GreyImage& image, std::uint64_t seed) {
  GreyImage noise = decompose_periodic(image).periodic;
  const FourierTransform fourier(image.width, image.height);
  std::vector<std::complex<double>> moduli(fourier.half_size());
  fourier.forward(noise.values, moduli);
  // The phases of white noise have the symmetry that a real image needs.
  CounterRandom random(seed);
  for (double& v : noise.values) v = random.normal();
  std::vector<std::complex<double>> half(fourier.half_size());
  fourier.forward(noise.values, half);
  for (std::size_t i = 0; i < half.size(); ++i) half[i] *= std::abs(moduli[i]) / std::abs(half[i]);
  fourier.inverse(half, noise.values);
  return noise;
}

namespace {

void add_pair(const GreyImage& left, const GreyImage& right_square, int seeds, const GaborFitOptions& options,
              HeldOut& sum) {
  const PowerSpectrum right = welch_spectrum(right_square);
  const auto to_right = [&](const PowerSpectrum& welch) { return optimal_transport_distance(welch, right); };
  const auto start = std::chrono::steady_clock::now();
  const GaborFit fit = fit_gabor_lobes(left, "left square", options);
  sum.seconds += std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
  sum.largest_recipe = std::max(sum.largest_recipe, recipe_size(fit));
  sum.largest_gap = std::max(sum.largest_gap, fit.pursuit.relative_gap);
  sum.lobe_count += static_cast<double>(fit.lobes.size());
  sum.photo += to_right(welch_spectrum(left));
  sum.expected_lobes += to_right(expected_welch_spectrum(fit.fitted));
  sum.expected_estimate += to_right(expected_welch_spectrum(fit.estimate.spectrum));
  sum.expected_random_phase +=
      to_right(expected_welch_spectrum(power_spectrum(decompose_periodic(left).periodic)));
  for (int i = 1; i <= seeds; ++i) {
    const auto seed = static_cast<std::uint64_t>(i);
    const GreyImage synthesis = synthesis_of(fit, left.width, seed);
    sum.lobes += to_right(welch_spectrum(synthesis)) / seeds;
    sum.variance_ratio += variance_of(synthesis.values) / variance_of(left.values) / seeds;
    sum.random_phase += to_right(welch_spectrum(random_phase_noise(left, seed))) / seeds;
  }
}

}  // namespace

HeldOut measure_held_out(const GreyImage& photo, int side, int seeds, const GaborFitOptions& options) {
  if (photo.width < 2 * side || photo.height < side)
    throw InputError("the photo is too small for the squares");
  HeldOut mean;
  mean.pairs = std::min(4, photo.height / side);
  for (int i = 0; i < mean.pairs; ++i) {
    const int y0 = (2 * i + 1) * photo.height / (2 * mean.pairs) - side / 2;
    add_pair(photo.part(photo.width / 2 - side, y0, side, side), photo.part(photo.width / 2, y0, side, side),
             seeds, options, mean);
  }
  for (double* value :
       {&mean.photo, &mean.random_phase, &mean.lobes, &mean.expected_random_phase, &mean.expected_lobes,
        &mean.expected_estimate, &mean.variance_ratio, &mean.lobe_count, &mean.seconds}) {
    *value /= mean.pairs;
  }
  return mean;
}

}  // namespace astrolith::testing
