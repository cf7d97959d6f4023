#include "estimation/shape/details/roughness.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "numerics/hash_random.h"
#include "synthesis/noise/noise_octaves.h"

namespace astrolith {
namespace {

constexpr double kLeastCycles = 0.02, kMostCycles = 8.0;
constexpr int kTableSize = 64;
constexpr int kTriplesPerEntry = 4096;
constexpr double kLargestLogRatio = 3.0;

// The relative error of a roughness from a few thousand lines.
constexpr double kRoughnessError = 0.02;

constexpr int kMostOctavesTried = 8;

double entry_cycles(double i) {
  return kLeastCycles * std::pow(kMostCycles / kLeastCycles, i / (kTableSize - 1));
}

Vec3d random_direction(CounterRandom& random) {
  const double z = random.uniform(-1.0, 1.0), angle = random.uniform(0.0, 6.283185307179586);
  const double r = std::sqrt(1.0 - z * z);
  return {r * std::cos(angle), r * std::sin(angle), z};
}

// The mean of (n(p + r u) - 2 n(p) + n(p - r u))^2 for one r, over random places p and directions u.
double mean_square(Noise noise, double r, CounterRandom random) {
  const NoiseOctave octave{1.0f, 1.0f, 1.0f, 12345u};
  std::vector<float> x[3];
  for (int i = 0; i < kTriplesPerEntry; ++i) {
    const Vec3d p{random.uniform(-500.0, 500.0), random.uniform(-500.0, 500.0),
                  random.uniform(-500.0, 500.0)};
    const Vec3d u = random_direction(random);
    for (const double side : {-r, 0.0, r}) {
      const Vec3d q = p + side * u;
      x[0].push_back(static_cast<float>(q.x));
      x[1].push_back(static_cast<float>(q.y));
      x[2].push_back(static_cast<float>(q.z));
    }
  }
  std::vector<float> value(x[0].size(), 0.0f);
  add_octave(noise, octave, static_cast<int>(value.size()), x[0].data(), x[1].data(), x[2].data(),
             value.data());
  double sum = 0.0;
  for (std::size_t i = 0; i < value.size(); i += 3) {
    const double d = double{value[i]} - 2.0 * double{value[i + 1]} + double{value[i + 2]};
    sum += d * d;
  }
  return sum / kTriplesPerEntry;
}

}  // namespace

std::vector<double> roughness(std::span<const double> heights,
                              const std::vector<std::vector<HeightTriple>>& lag_triples) {
  std::vector<double> result;
  for (const std::vector<HeightTriple>& triples : lag_triples) {
    double sum = 0.0;
    for (const HeightTriple& t : triples) {
      const double d = heights[t.before] - 2.0 * heights[t.middle] + heights[t.after];
      sum += d * d;
    }
    result.push_back(std::sqrt(sum / static_cast<double>(std::max<std::size_t>(triples.size(), 1))));
  }
  return result;
}

RoughnessModel::RoughnessModel() {
  for (std::size_t which = 0; which < 3; ++which) {
    for (int i = 0; i < kTableSize; ++i) {
      const CounterRandom random(which, static_cast<std::uint64_t>(i));
      tables_[which].push_back(mean_square(kDetailNoises[which], entry_cycles(i), random));
    }
  }
}

// Interpolates the table linearly in the logarithms. Below the table a second difference grows with the
// square of the lag. Above it heights are independent, and the roughness is constant.
double RoughnessModel::squared(std::size_t which, double cycles) const {
  const std::vector<double>& table = tables_[which];
  if (cycles <= kLeastCycles) return table.front() * std::pow(cycles / kLeastCycles, 4);
  const double at = std::log(cycles / kLeastCycles) / std::log(kMostCycles / kLeastCycles) * (kTableSize - 1);
  if (at >= kTableSize - 1) return table.back();
  const auto i = static_cast<std::size_t>(at);
  const double part = at - std::floor(at);
  return std::exp((1.0 - part) * std::log(table[i]) + part * std::log(table[i + 1]));
}

std::vector<double> RoughnessModel::of(const PlainNoise& noise, std::span<const double> lags) const {
  std::vector<double> result;
  for (const double r : lags) {
    double sum = 0.0, frequency = noise.frequency, gain = 1.0;
    for (int o = 0; o < noise.octaves; ++o) {
      sum += gain * gain * squared(noise.which, frequency * r);
      frequency *= kDetailLacunarity;
      gain *= noise.gain;
    }
    result.push_back(std::sqrt(sum));
  }
  return result;
}

namespace {

struct RoughNoise {
  PlainNoise noise;
  double misfit = 0.0;  // root mean square of the log ratios
};

// Finds the best noise for one number of octaves.
class RoughnessFit {
 public:
  RoughnessFit(std::span<const double> wanted, std::span<const double> lags, const DetailRanges& ranges,
               const RoughnessModel& model)
      : wanted_(wanted), lags_(lags), ranges_(ranges), model_(model) {}

  RoughNoise best(std::size_t which, int octaves) const {
    const auto noise_at = [&](std::span<const double> x) {
      return PlainNoise{which, 1.0, std::exp(x[0]), octaves, octaves > 1 ? x[1] : 0.5};
    };
    const Objective misfit = [&](std::span<const double> x) { return scaled(noise_at(x)).misfit; };
    // The last octave's frequency must stay within the ranges.
    const double highest = ranges_.highest_frequency * std::pow(kDetailLacunarity, 1 - octaves);
    const Bounds bounds{{std::log(ranges_.lowest_frequency), 0.0},
                        {std::log(std::max(highest, ranges_.lowest_frequency)), 0.9}};
    OptimizeOptions options;
    options.algorithm = OptimizerAlgorithm::crs2;
    options.max_evaluations = 600;
    return scaled(noise_at(minimize(misfit, bounds, options).x));
  }

 private:
  // The noise with the amplitude that fits best, and its misfit.
  RoughNoise scaled(PlainNoise noise) const {
    const std::vector<double> roughness = model_.of(noise, lags_);
    double sum = 0.0, squares = 0.0;
    for (std::size_t k = 0; k < lags_.size(); ++k) {
      const double ratio = std::log(std::max(wanted_[k], 1e-30) / roughness[k]);
      sum += ratio;
      squares += ratio * ratio;
    }
    const double n = static_cast<double>(lags_.size()), mean = sum / n;
    noise.amplitude = std::clamp(std::exp(mean), ranges_.least_amplitude, ranges_.largest_amplitude);
    return {noise, std::sqrt(std::max(0.0, squares / n - mean * mean))};
  }

  std::span<const double> wanted_, lags_;
  const DetailRanges& ranges_;
  const RoughnessModel& model_;
};

}  // namespace

std::vector<PlainNoise> noises_as_rough_as(std::span<const double> wanted, std::span<const double> lags,
                                           std::size_t which, const DetailRanges& ranges,
                                           const RoughnessModel& model) {
  const RoughnessFit fit(wanted, lags, ranges, model);
  std::vector<RoughNoise> by_octaves;
  double least = std::numeric_limits<double>::infinity();
  for (int octaves = 1; octaves <= kMostOctavesTried; ++octaves) {
    const double finest = ranges.lowest_frequency * std::pow(kDetailLacunarity, octaves - 1);
    if (octaves > 1 && finest > ranges.highest_frequency) break;
    by_octaves.push_back(fit.best(which, octaves));
    least = std::min(least, by_octaves.back().misfit);
  }
  std::vector<PlainNoise> good;
  for (const RoughNoise& candidate : by_octaves) {
    if (candidate.misfit <= least + kRoughnessError) good.push_back(candidate.noise);
  }
  return good;
}

double roughness_misfit(std::span<const double> a, std::span<const double> b) {
  double sum = 0.0;
  for (std::size_t k = 0; k < a.size(); ++k) {
    const double ratio = std::log(std::max(a[k], 1e-30) / std::max(b[k], 1e-30));
    sum += std::pow(std::clamp(ratio, -kLargestLogRatio, kLargestLogRatio), 2);
  }
  return std::sqrt(sum / static_cast<double>(std::max<std::size_t>(a.size(), 1)));
}

}  // namespace astrolith
