#include "synthesis/relief/patch_features.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "numerics/hash_random.h"
#include "numerics/host_device.h"
#include "numerics/parallel_for.h"
#include "numerics/portable_double.h"

namespace astrolith {
namespace {

constexpr float kSoft = 0.15f;  // half width of the level's edge, in root mean squares of answers

// A nearly normal number of variance 1.
float draw_normal(std::uint32_t& hash) {
  double sum = -2.0;
  for (int k = 0; k < 4; ++k) sum += double{unit_float(hash = hash_append(hash, 1))};
  return static_cast<float>(std::sqrt(3.0) * sum);
}

// row_x += tap from_x for the rows of a square: `from` has one stride, `to` another.
ASTROLITH_SIMD_CLONES void add_rows(std::size_t across, float tap, const float* from, std::size_t from_stride,
                                    float* to, std::size_t to_stride) {
  for (std::size_t y = 0; y < across; ++y) {
#pragma omp simd
    for (std::size_t x = 0; x < across; ++x) to[y * to_stride + x] += tap * from[y * from_stride + x];
  }
}

struct Spread {
  float mean, deviation;
};

Spread spread_of(const float* values, std::size_t n) {
  constexpr double kLeast = 1e-3;  // so that flat patches have a logarithm
  double sum = 0.0, squares = 0.0;
  for (std::size_t i = 0; i < n; ++i)
    sum += double{values[i]}, squares += double{values[i]} * double{values[i]};
  const double mean = sum / static_cast<double>(n), variance = squares / static_cast<double>(n) - mean * mean;
  return {static_cast<float>(mean), static_cast<float>(std::sqrt(std::max(variance, 0.0)) + kLeast)};
}

template <typename Work>
void for_each_patch(std::size_t n, const Work& work) {
  parallel_for(
      0, static_cast<std::int64_t>(n), [&](std::int64_t i) { work(static_cast<std::size_t>(i)); }, 16);
}

}  // namespace

PatchFeatures::Filter PatchFeatures::draw(std::size_t number, std::uint32_t& hash) {
  Filter filter{2 + number % 4, 1 + number / 4, {}, 0.0f};
  const std::size_t taps = filter.side * filter.side;
  float mean = 0.0f;
  for (std::size_t k = 0; k < taps; ++k) {
    filter.taps.push_back(draw_normal(hash));
    mean += filter.taps.back() / static_cast<float>(taps);
  }
  for (float& tap : filter.taps) tap -= mean;
  filter.level = 0.5f * draw_normal(hash);
  return filter;
}

// Writes the answers row by row, and returns their number.
std::size_t PatchFeatures::answer(const Filter& filter, const float* patch, float* answers) {
  const std::size_t across = filter.across(), n = across * across;
  std::fill(answers, answers + n, 0.0f);
  for (std::size_t k = 0; k < filter.taps.size(); ++k)
    add_rows(across, filter.taps[k], patch + filter.offset(k), kSide, answers, across);
  return n;
}

// The transpose of answer().
void PatchFeatures::spread(const Filter& filter, const float* by, float* patch) {
  const std::size_t across = filter.across();
  for (std::size_t k = 0; k < filter.taps.size(); ++k)
    add_rows(across, filter.taps[k], by, across, patch + filter.offset(k), kSide);
}

PatchFeatures::PatchFeatures(const std::vector<float>& measured, std::uint32_t hash) {
  constexpr std::size_t kEnough = 256;
  constexpr double kLeast = 1e-12;
  const std::size_t n = measured.size() / kSamples, stride = 1 + n / kEnough;
  std::array<float, kSamples> answers;
  for (std::size_t f = 0; f < kFilters; ++f) {
    Filter filter = draw(f, hash);
    double squares = 0.0, count = 0.0;
    for (std::size_t p = 0; p < n; p += stride) {
      const std::size_t m = answer(filter, &measured[p * kSamples], answers.data());
      for (std::size_t i = 0; i < m; ++i) squares += double{answers[i]} * double{answers[i]};
      count += static_cast<double>(m);
    }
    const auto scale = static_cast<float>(1.0 / std::sqrt(std::max(squares / count, kLeast)));
    for (float& tap : filter.taps) tap *= scale;
    filters_.push_back(std::move(filter));
  }
}

std::vector<float> PatchFeatures::of(const std::vector<float>& patches) const {
  std::vector<float> features(patches.size() / kSamples * kColumns);
  for_each_patch(patches.size() / kSamples, [&](std::size_t p) {
    std::array<float, kSamples> answers;
    float* feature = &features[p * kColumns];
    for (const Filter& filter : filters_) {
      const std::size_t n = answer(filter, &patches[p * kSamples], answers.data());
      float share = 0.0f;
      for (std::size_t i = 0; i < n; ++i) {
        const float over = (answers[i] - filter.level) / kSoft;
        share += 0.5f + 0.5f * over / (1.0f + std::fabs(over));
      }
      *feature++ = static_cast<float>(portable::log(double{spread_of(answers.data(), n).deviation}));
      *feature++ = *std::max_element(answers.data(), answers.data() + n);
      *feature++ = share / static_cast<float>(n);
    }
  });
  return features;
}

std::vector<float> PatchFeatures::gradient(const std::vector<float>& patches,
                                           const std::vector<float>& by) const {
  std::vector<float> gradient(patches.size(), 0.0f);
  for_each_patch(patches.size() / kSamples, [&](std::size_t p) {
    std::array<float, kSamples> answers, slopes;
    const float* factor = &by[p * kColumns];
    for (const Filter& filter : filters_) {
      const std::size_t n = answer(filter, &patches[p * kSamples], answers.data());
      const Spread around = spread_of(answers.data(), n);
      const auto count = static_cast<float>(n);
      const float of_spread = factor[0] / (count * around.deviation * around.deviation),
                  of_share = 0.5f * factor[2] / (count * kSoft);
      for (std::size_t i = 0; i < n; ++i) {
        const float off = 1.0f + std::fabs((answers[i] - filter.level) / kSoft);
        slopes[i] = of_spread * (answers[i] - around.mean) + of_share / (off * off);
      }
      slopes[static_cast<std::size_t>(std::max_element(answers.data(), answers.data() + n) -
                                      answers.data())] += factor[1];
      factor += 3;
      spread(filter, slopes.data(), &gradient[p * kSamples]);
    }
  });
  return gradient;
}

}  // namespace astrolith
