#include "recipe/compact/height_picture.h"

#include <algorithm>

#include "recipe/compact/height_mask_internal.h"
#include "recipe/compact/height_values_internal.h"

namespace astrolith {
namespace {

constexpr std::uint64_t kSides = kMostHeightPictureSide + 1;
constexpr std::uint64_t kValues = 65536;

HeightRange range_of(const HeightPicture& picture) {
  HeightRange range{65535, 0};
  for (const std::uint16_t value : picture.values) {
    if (value == 0) continue;
    range.low = std::min<int>(range.low, value);
    range.high = std::max<int>(range.high, value);
  }
  return range;
}

bool has_heights(const HeightPicture& picture) {
  return std::any_of(picture.values.begin(), picture.values.end(), [](std::uint16_t v) { return v != 0; });
}

}  // namespace

void encode(const HeightPicture& picture, RangeEncoder& encoder) {
  encoder.encode_uniform(static_cast<std::uint64_t>(picture.width), kSides);
  encoder.encode_uniform(static_cast<std::uint64_t>(picture.height), kSides);
  HeightPicture copy = picture;
  BitCoder coder(encoder);
  code_mask(copy, coder);
  if (!has_heights(copy)) return;
  const HeightRange range = range_of(copy);
  encoder.encode_uniform(static_cast<std::uint64_t>(range.low), kValues);
  encoder.encode_uniform(static_cast<std::uint64_t>(range.high), kValues);
  code_heights(copy, range, coder);
}

HeightPicture decode(std::size_t most_pixels, RangeDecoder& decoder) {
  HeightPicture picture;
  picture.width = static_cast<int>(decoder.decode_uniform(kSides));
  picture.height = static_cast<int>(decoder.decode_uniform(kSides));
  if (picture.pixels() > most_pixels) throw DamagedStream();
  BitCoder coder(decoder);
  code_mask(picture, coder);
  if (!has_heights(picture)) return picture;
  HeightRange range;
  range.low = static_cast<int>(decoder.decode_uniform(kValues));
  range.high = static_cast<int>(decoder.decode_uniform(kValues));
  if (range.low < 1 || range.low > range.high) throw DamagedStream();
  code_heights(picture, range, coder);
  return picture;
}

}  // namespace astrolith
