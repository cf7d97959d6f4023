#include "recipe/compact/text_model.h"

#include <algorithm>

namespace astrolith {
namespace {

// No bit is thought less probable than this share.
constexpr std::uint32_t kLeastShare = 24;
constexpr std::uint8_t kMostCounts = 250;

std::uint32_t hash_bytes(std::uint64_t bytes, int count) {
  const std::uint64_t kept = bytes & ((std::uint64_t{1} << (8 * count)) - 1);
  return static_cast<std::uint32_t>(((kept + 1) * 0x9e3779b97f4a7c15u) >> 32);
}

}  // namespace

TextModel::TextModel(std::string_view primer) {
  for (std::vector<Counts>& counts : counts_) counts.resize(std::size_t{1} << kSlotBits);
  advance(0);
  for (const char c : primer) {
    const auto byte = static_cast<std::uint8_t>(c);
    pass_byte([&](int place, std::uint32_t) { return (byte >> place & 1) != 0; });
  }
}

void TextModel::encode(std::string_view text, RangeEncoder& encoder) {
  for (const char c : text) {
    const auto byte = static_cast<std::uint8_t>(c);
    pass_byte([&](int place, std::uint32_t one) {
      const bool bit = (byte >> place & 1) != 0;
      encoder.encode(bit ? 0 : one, bit ? one : kProbabilityScale - one, kProbabilityScale);
      return bit;
    });
  }
}

std::string TextModel::decode(std::size_t size, RangeDecoder& decoder) {
  std::string text;
  for (std::size_t i = 0; i < size; ++i) {
    text += static_cast<char>(pass_byte([&](int, std::uint32_t one) {
      const bool bit = decoder.share(kProbabilityScale) < one;
      decoder.take(bit ? 0 : one, bit ? one : kProbabilityScale - one);
      return bit;
    }));
  }
  return text;
}

// Calls code(place of the bit, share of a 1), which returns the bit, for the eight bits of a byte.
template <class Code>
std::uint8_t TextModel::pass_byte(const Code& code) {
  std::uint32_t prefix = 1;
  for (int place = 7; place >= 0; --place) {
    const std::uint32_t one = find_contexts(prefix);
    const bool bit = code(place, one);
    learn(bit);
    prefix = prefix << 1 | (bit ? 1 : 0);
  }
  const auto byte = static_cast<std::uint8_t>(prefix);
  advance(byte);
  return byte;
}

// The share of a 1 after the bits `prefix` of the byte. Each context weighs against all shorter ones by how
// often it has been seen: share = (2 ones + share of the shorter ones) / (2 seen + 1).
std::uint32_t TextModel::find_contexts(std::uint32_t prefix) {
  std::uint32_t share = kProbabilityScale / 2;
  for (int order = 0; order <= kLongest; ++order) {
    const std::uint32_t slot = (hashes_[order] + prefix * 0x85ebca6bu) >> (32 - kSlotBits);
    Counts& counts = counts_[order][order == 0 ? prefix : slot];
    found_[order] = &counts;
    const std::uint32_t ones = counts.of[1], seen = ones + counts.of[0];
    share = (2 * ones * kProbabilityScale + share) / (2 * seen + 1);
  }
  return std::clamp(share, kLeastShare, kProbabilityScale - kLeastShare);
}

void TextModel::learn(bool bit) {
  for (Counts* counts : found_) {
    std::uint8_t& same = counts->of[bit ? 1 : 0];
    std::uint8_t& other = counts->of[bit ? 0 : 1];
    if (same < kMostCounts) ++same;
    if (other > 2) other = static_cast<std::uint8_t>(other / 2 + 1);
  }
}

void TextModel::advance(std::uint8_t byte) {
  last_bytes_ = last_bytes_ << 8 | byte;
  for (int order = 0; order <= kLongest; ++order) hashes_[order] = hash_bytes(last_bytes_, order);
}

}  // namespace astrolith
