#include "recipe/compact/range_coder.h"

#include <algorithm>
#include <bit>

namespace astrolith {
namespace {

constexpr std::uint32_t kLeastRange = std::uint32_t{1} << 24;
constexpr int kDigitBits = 16;

// A value below `count` is written in digits of 16 bits, the highest first. The bits below the first digit.
int bits_below_first_digit(std::uint64_t count) {
  return std::max(0, static_cast<int>(std::bit_width(count - 1)) - kDigitBits);
}

}  // namespace

void RangeEncoder::encode(std::uint32_t start, std::uint32_t size, std::uint32_t total) {
  range_ /= total;
  low_ += std::uint64_t{start} * range_;
  range_ *= size;
  while (range_ < kLeastRange) {
    range_ <<= 8;
    shift_low();
  }
}

void RangeEncoder::encode_uniform(std::uint64_t value, std::uint64_t count) {
  while (count > 1) {
    const int below = bits_below_first_digit(count);
    encode(static_cast<std::uint32_t>(value >> below), 1,
           static_cast<std::uint32_t>((count - 1) >> below) + 1);
    count = std::uint64_t{1} << below;
    value &= count - 1;
  }
}

void RangeEncoder::encode_number(std::uint64_t value) {
  const int bits = std::bit_width(value);
  encode_uniform(static_cast<std::uint64_t>(bits), 65);
  if (bits > 1) encode_uniform(value ^ (std::uint64_t{1} << (bits - 1)), std::uint64_t{1} << (bits - 1));
}

// Moves the highest byte of `low_` out. Bytes 255 wait, since a carry would turn them into zeros.
void RangeEncoder::shift_low() {
  const bool carry = (low_ >> 32) != 0;
  const bool first = pending_count_ == 0;
  if (low_ < 0xff000000u || carry || first) {
    for (std::uint64_t i = 0; i < pending_count_; ++i) {
      bytes_ += static_cast<char>(static_cast<std::uint8_t>((i == 0 ? pending_ : 0xff) + (carry ? 1 : 0)));
    }
    pending_ = static_cast<std::uint8_t>(low_ >> 24);
    pending_count_ = 0;
  }
  ++pending_count_;
  low_ = (low_ & 0x00ffffffu) << 8;
}

std::string RangeEncoder::finish() {
  // The number in [low, low + range) with the most zeros at its end.
  for (int bits = 32; bits >= 0; --bits) {
    const std::uint64_t mask = (std::uint64_t{1} << bits) - 1;
    const std::uint64_t candidate = (low_ + mask) & ~mask;
    if (candidate - low_ < range_) {
      low_ = candidate;
      break;
    }
  }
  for (int i = 0; i < 5; ++i) shift_low();
  for (std::size_t i = 0; i < kMostZerosLeftOut && !bytes_.empty() && bytes_.back() == 0; ++i)
    bytes_.pop_back();
  return std::move(bytes_);
}

RangeDecoder::RangeDecoder(std::string_view bytes) : bytes_(bytes) {
  for (int i = 0; i < 4; ++i) code_ = code_ << 8 | next_byte();
}

std::uint32_t RangeDecoder::share(std::uint32_t total) {
  range_ /= total;
  return std::min(code_ / range_, total - 1);
}

void RangeDecoder::take(std::uint32_t start, std::uint32_t size) {
  code_ -= start * range_;
  range_ *= size;
  while (range_ < kLeastRange) {
    range_ <<= 8;
    code_ = code_ << 8 | next_byte();
  }
}

std::uint64_t RangeDecoder::decode_uniform(std::uint64_t count) {
  const std::uint64_t all = count;
  std::uint64_t value = 0;
  while (count > 1) {
    const int below = bits_below_first_digit(count);
    const std::uint32_t digit = share(static_cast<std::uint32_t>((count - 1) >> below) + 1);
    take(digit, 1);
    count = std::uint64_t{1} << below;
    value |= std::uint64_t{digit} << below;
  }
  if (value >= all) throw DamagedStream();
  return value;
}

std::uint64_t RangeDecoder::decode_number() {
  const auto bits = static_cast<int>(decode_uniform(65));
  if (bits < 2) return static_cast<std::uint64_t>(bits);
  const std::uint64_t top = std::uint64_t{1} << (bits - 1);
  return top | decode_uniform(top);
}

std::uint8_t RangeDecoder::next_byte() {
  if (position_ >= bytes_.size() + kMostZerosLeftOut) throw DamagedStream();
  const std::size_t at = position_++;
  return at < bytes_.size() ? static_cast<std::uint8_t>(bytes_[at]) : std::uint8_t{0};
}

}  // namespace astrolith
