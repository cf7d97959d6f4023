// A model of a recipe's text, so that field names and the words of a common recipe take hardly any bytes.
#pragma once

#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

#include "recipe/compact/range_coder.h"

namespace astrolith {

// Predicts each bit of a text from the bits of its byte so far and the bytes before it: from no byte, from
// the last byte, and so on to the last six. A longer context that has been seen outweighs the shorter ones.
// The model has read the text `primer`, which belongs to the format, before it reads the recipe's.
class TextModel {
 public:
  explicit TextModel(std::string_view primer);

  void encode(std::string_view text, RangeEncoder& encoder);
  std::string decode(std::size_t size, RangeDecoder& decoder);

 private:
  static constexpr int kLongest = 6;  // bytes of the longest context
  static constexpr int kSlotBits = 16;

  // How often a bit was 0 and 1 in one context.
  struct Counts {
    std::uint8_t of[2] = {0, 0};
  };

  template <class Code>
  std::uint8_t pass_byte(const Code& code);
  std::uint32_t find_contexts(std::uint32_t prefix);
  void learn(bool bit);
  void advance(std::uint8_t byte);

  std::vector<Counts> counts_[kLongest + 1];
  Counts* found_[kLongest + 1] = {};         // the contexts of the bit at hand
  std::uint32_t hashes_[kLongest + 1] = {};  // of the last 0 .. kLongest bytes
  std::uint64_t last_bytes_ = 0;
};

}  // namespace astrolith
