#include "estimation/shape/details/detail_parameters.h"

#include <algorithm>
#include <cmath>

namespace astrolith {
namespace {

constexpr std::size_t kPerNoise = 10, kGradient = 30, kFirstGain = 31;
constexpr int kMostOctaves = 8;
constexpr double kLeastWeight = 1e-3;
constexpr double kLargestScale = 2.0;  // of the coordinates; the least is its inverse
constexpr double kLargestModulation = 2.0, kLargestGain = 0.9;

constexpr const char* kNames[] = {"details: Perlin", "details: simplex", "details: Worley"};

// The wanted number of octaves, less the ones above the highest frequency; at least one.
int resolved_octaves(double frequency, double wanted, double highest) {
  const double most = 1.0 + std::log(std::max(highest / frequency, 1.0)) / std::log(kDetailLacunarity);
  return std::clamp(static_cast<int>(std::lround(wanted)), 1, static_cast<int>(most + 1e-9));
}

// The greatest slope of a noise with amplitude and frequency 1, from synthesis/noise/noise_octaves.h.
double greatest_slope(Noise noise) {
  return noise == Noise::kSimplex ? 7.0 : noise == Noise::kPerlin ? 3.65 : 1.0;
}

Vec3d exp_vector(std::span<const double> x) { return {std::exp(x[0]), std::exp(x[1]), std::exp(x[2])}; }

}  // namespace

Bounds detail_bounds(const DetailRanges& ranges) {
  Bounds bounds;
  const auto add = [&](double low, double high) {
    bounds.lower.push_back(low);
    bounds.upper.push_back(high);
  };
  for (const Noise noise : kDetailNoises) {
    add(is_worley(noise) ? -1.0 : 0.0, 1.0);
    add(std::log(ranges.lowest_frequency), std::log(ranges.highest_frequency));
    add(1.0, kMostOctaves);
    add(std::log(ranges.least_amplitude), std::log(ranges.largest_amplitude));
    for (int axis = 0; axis < 3; ++axis) add(-std::log(kLargestScale), std::log(kLargestScale));
    for (int axis = 0; axis < 3; ++axis) add(-ranges.bias, ranges.bias);
  }
  add(0.0, kLargestModulation);
  for (int noise = 0; noise < 3; ++noise) add(0.0, kLargestGain);
  return bounds;
}

std::vector<double> detail_parameters(const PlainNoise& noise, const DetailRanges& ranges) {
  std::vector<double> x(kDetailParameters, 0.0);
  for (std::size_t i = 0; i < 3; ++i) {
    const bool chosen = i == noise.which;
    double* const own = x.data() + kPerNoise * i;
    own[0] = chosen ? 1.0 : 0.0;
    own[1] =
        std::log(chosen ? noise.frequency : std::sqrt(ranges.lowest_frequency * ranges.highest_frequency));
    own[2] = chosen ? noise.octaves : 1.0;
    own[3] = std::log(chosen ? noise.amplitude : ranges.least_amplitude);
    x[kFirstGain + i] = chosen ? noise.gain : 0.5;
  }
  return x;
}

std::vector<FractalLayer> detail_layers(std::span<const double> x, const DetailRanges& ranges) {
  std::vector<FractalLayer> layers;
  for (std::size_t i = 0; i < 3; ++i) {
    const auto own = x.subspan(kPerNoise * i, kPerNoise);
    if (std::fabs(own[0]) < kLeastWeight) continue;
    FractalLayer layer;
    layer.name = kNames[i];
    layer.noise = kDetailNoises[i];
    layer.weight = own[0];
    layer.frequency = std::exp(own[1]);
    layer.octaves = resolved_octaves(layer.frequency, own[2], ranges.highest_frequency);
    layer.amplitude = std::exp(own[3]);
    layer.scale = exp_vector(own.subspan(4, 3));
    layer.bias = {own[7], own[8], own[9]};
    layer.gain = x[kFirstGain + i];
    layer.lacunarity = kDetailLacunarity;
    if (!is_worley(layer.noise)) layer.gradient_modulation = x[kGradient];
    layers.push_back(layer);
  }
  return layers;
}

double steepness(std::span<const FractalLayer> layers) {
  double sum = 0.0;
  for (const FractalLayer& layer : layers) {
    const double scale =
        std::max({std::fabs(layer.scale.x), std::fabs(layer.scale.y), std::fabs(layer.scale.z)});
    double slope = greatest_slope(layer.noise) * std::fabs(layer.amplitude * layer.weight) * layer.frequency *
                   scale * (layer.gradient_modulation > 0.0 ? 2.0 : 1.0);
    for (int o = 0; o < layer.octaves; ++o, slope *= layer.gain * layer.lacunarity) sum += slope;
  }
  return sum;
}

}  // namespace astrolith
