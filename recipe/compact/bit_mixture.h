// Probabilities of bits in integer arithmetic: counters that learn, and mixtures of several opinions as in
// PAQ (Mahoney, "Adaptive weighing of context models for lossless data compression", 2005).
//
// An opinion is the logarithm of the odds of a 1, log2(p / (1 - p)), in units of 1/256.
#pragma once

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>

#include "recipe/compact/range_coder.h"

namespace astrolith {

inline constexpr int kOctave = 256;  // a factor of two, in the units of opinions

// log2(value) for value > 0, in the units of opinions.
int log2_units(std::uint64_t value);

// The share 1 / (1 + 2^x) of 2^40 for x >= 0: the tail of the logistic distribution.
std::uint64_t logistic_tail(std::int64_t x);

// The share of a 1 that an opinion means, of kProbabilityScale, with some probability left for either bit.
std::uint32_t to_probability(std::int64_t opinion);

// The share of ones among the bits of one context. Later bits count more.
class BitCounter {
 public:
  int opinion() const { return log2_units(ones_) - log2_units(kProbabilityScale - ones_); }
  void learn(bool bit);

 private:
  std::uint16_t ones_ = kProbabilityScale / 2;
  std::uint8_t seen_ = 0;
};

// A weighted sum of opinions. An opinion that was right gains weight.
template <std::size_t N>
class BitMixture {
 public:
  using Opinions = std::array<int, N>;

  // The weights of opinions at the start, of kWhole.
  explicit BitMixture(const Opinions& weights) : weights_(weights) {}

  std::uint32_t share(const Opinions& opinions) const {
    std::int64_t sum = 0;
    for (std::size_t i = 0; i < N; ++i) sum += std::int64_t{opinions[i]} * weights_[i];
    return to_probability(sum / kWhole);
  }
  void learn(const Opinions& opinions, std::uint32_t share, bool bit) {
    const std::int64_t error = (bit ? std::int64_t{kProbabilityScale} : 0) - std::int64_t{share};
    for (std::size_t i = 0; i < N; ++i) {
      const int change = static_cast<int>(opinions[i] * error / kSlowness);
      weights_[i] = std::clamp(weights_[i] + change, -kMostWeight, kMostWeight);
    }
  }

  static constexpr int kWhole = 65536;

 private:
  static constexpr int kSlowness = 65536;
  static constexpr int kMostWeight = 16 * kWhole;

  Opinions weights_;
};

// Writes bits or reads them, so that one function describes a format in both directions.
class BitCoder {
 public:
  explicit BitCoder(RangeEncoder& encoder) : encoder_(&encoder) {}
  explicit BitCoder(RangeDecoder& decoder) : decoder_(&decoder) {}

  // Writes the bit, whose share of a 1 is `one`, and returns it; or ignores `bit` and returns the one it
  // reads.
  bool code(bool bit, std::uint32_t one);

 private:
  RangeEncoder* encoder_ = nullptr;
  RangeDecoder* decoder_ = nullptr;
};

}  // namespace astrolith
