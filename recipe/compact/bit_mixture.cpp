#include "recipe/compact/bit_mixture.h"

#include <algorithm>
#include <bit>

namespace astrolith {
namespace {

// No bit is thought less probable than this share, so that a few bytes cannot hold millions of bits.
constexpr std::uint32_t kLeastChance = 24;
constexpr int kMostSeen = 120;
constexpr std::int64_t kLongestTail = 32 * kOctave;

// 2^(-i / 256) as shares of 2^63.
constexpr std::array<std::uint64_t, kOctave + 1> kPowers = [] {
  __extension__ using Wide = unsigned __int128;
  constexpr std::uint64_t kRoot = 0x7fa765aca88f6452u;  // 2^(-1 / 256)
  std::array<std::uint64_t, kOctave + 1> powers{std::uint64_t{1} << 63};
  for (std::size_t i = 1; i <= kOctave; ++i)
    powers[i] = static_cast<std::uint64_t>((Wide{powers[i - 1]} * kRoot) >> 63);
  return powers;
}();

// The first i with 2^(-i / 256) <= the greatest mantissa that begins with the 11 bits 1 and k.
constexpr std::size_t kMantissas = 1024;
constexpr std::array<std::uint16_t, kMantissas> kFirstPowers = [] {
  std::array<std::uint16_t, kMantissas> first{};
  for (std::uint64_t k = 0; k < kMantissas; ++k) {
    const std::uint64_t greatest = ((kMantissas + k + 1) << 52) - 1;
    std::uint16_t i = 0;
    while (kPowers[i] > greatest) ++i;
    first[k] = i;
  }
  return first;
}();

}  // namespace

int log2_units(std::uint64_t value) {
  const int bits = std::bit_width(value);
  const std::uint64_t mantissa = value << (64 - bits) >> 1;
  std::size_t power = kFirstPowers[(mantissa >> 52) % kMantissas];
  while (kPowers[power] > mantissa) ++power;
  return bits * kOctave - static_cast<int>(power);
}

std::uint64_t logistic_tail(std::int64_t x) {
  if (x >= kLongestTail) return 0;
  const std::uint64_t power = kPowers[static_cast<std::size_t>(x % kOctave)] >> (23 + x / kOctave);
  return (power << 22) / (((std::uint64_t{1} << 40) + power) >> 18);
}

std::uint32_t to_probability(std::int64_t opinion) {
  const auto tail = static_cast<std::uint32_t>(logistic_tail(opinion < 0 ? -opinion : opinion) >> 24);
  const std::uint32_t less = std::max(tail, kLeastChance);
  return opinion < 0 ? less : kProbabilityScale - less;
}

void BitCounter::learn(bool bit) {
  const int error = (bit ? 65535 : 0) - ones_;
  ones_ = static_cast<std::uint16_t>(std::clamp(ones_ + 2 * error / (2 * seen_ + 3), 16, 65520));
  if (seen_ < kMostSeen) ++seen_;
}

bool BitCoder::code(bool bit, std::uint32_t one) {
  if (decoder_ != nullptr) bit = decoder_->share(kProbabilityScale) < one;
  const std::uint32_t start = bit ? 0 : one;
  const std::uint32_t size = bit ? one : kProbabilityScale - one;
  if (decoder_ != nullptr) {
    decoder_->take(start, size);
  } else {
    encoder_->encode(start, size, kProbabilityScale);
  }
  return bit;
}

}  // namespace astrolith
