#include "recipe/relief_text.h"

#include <utility>

#include "recipe/base64.h"
#include "recipe/compact/height_picture.h"

namespace astrolith {

std::string relief_text(const ReliefLayer& layer) {
  const ExemplarImage& image = *layer.pixels;
  HeightPicture picture{image.width, image.height, image.values};
  // Codes, from 1: small numbers take fewer bits than grey values.
  for (std::uint16_t& value : picture.values) {
    if (value != 0) value = static_cast<std::uint16_t>(layer.code_of(value) + 1);
  }
  RangeEncoder encoder;
  encode(picture, encoder);
  return base64_text(encoder.finish());
}

std::shared_ptr<const ExemplarImage> relief_pixels(const ReliefLayer& layer, std::string_view text) {
  constexpr std::size_t kMostPixelsOfByte = 400;  // a body's picture has some ten
  const std::optional<std::string> bytes = base64_bytes(text);
  if (!bytes) return nullptr;
  try {
    RangeDecoder decoder(*bytes);
    HeightPicture picture = decode(kMostPixelsOfByte * bytes->size(), decoder);
    for (std::uint16_t& value : picture.values) {
      if (value > layer.levels) return nullptr;
      if (value != 0) value = layer.value_of(static_cast<std::uint16_t>(value - 1));
    }
    return std::make_shared<ExemplarImage>(
        ExemplarImage{picture.width, picture.height, std::move(picture.values), {}});
  } catch (const DamagedStream&) {
    return nullptr;
  }
}

}  // namespace astrolith
