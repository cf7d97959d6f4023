#include "recipe/compact/height_picture.h"

#include <algorithm>
#include <array>
#include <string>

#include "numerics/parallel_for.h"
#include "recipe/compact/bit_mixture.h"
#include "recipe/compact/height_values_internal.h"

namespace astrolith {
namespace {

struct Offset {
  int x, y;
};

// The pixels that predict a pixel, the nearest first.
constexpr Offset kAround[] = {{-1, 0}, {0, -1},  {1, -1}, {-1, -1}, {-2, 0},  {0, -2}, {2, -1},  {-2, -1},
                              {1, -2}, {-1, -2}, {3, -1}, {-3, 0},  {-3, -1}, {2, -2}, {-2, -2}, {3, -2}};
constexpr int kNear = 10, kFar = 16, kChoosing = 4;

// The bits of the pixels around (x, y), of which those outside the picture are holes.
std::size_t bits_around(const HeightPicture& picture, int x, int y) {
  std::size_t bits = 0;
  for (std::size_t i = 0; i < kFar; ++i) {
    const int column = x + kAround[i].x, row = y + kAround[i].y;
    if (column < 0 || column >= picture.width || row < 0) continue;
    const auto at = static_cast<std::size_t>(row) * static_cast<std::size_t>(picture.width);
    if (picture.values[at + static_cast<std::size_t>(column)] != 0) bits |= std::size_t{1} << i;
  }
  return bits;
}

class MaskModel {
 public:
  bool code(bool bit, std::size_t around, BitCoder& coder) {
    const auto lowest = [&](int n) { return around & ((std::size_t{1} << n) - 1); };
    BitCounter& near = near_[lowest(kNear)];
    BitCounter& far = far_[lowest(kFar)];
    BitMixture<2>& mixture = mixtures_[lowest(kChoosing)];
    const BitMixture<2>::Opinions opinions = {near.opinion(), far.opinion()};
    const std::uint32_t one = mixture.share(opinions);
    bit = coder.code(bit, one);
    mixture.learn(opinions, one, bit);
    near.learn(bit);
    far.learn(bit);
    return bit;
  }

 private:
  using Mixture = BitMixture<2>;

  std::vector<BitCounter> near_ = std::vector<BitCounter>(std::size_t{1} << kNear);
  std::vector<BitCounter> far_ = std::vector<BitCounter>(std::size_t{1} << kFar);
  std::vector<Mixture> mixtures_ =
      std::vector<Mixture>(std::size_t{1} << kChoosing, Mixture({Mixture::kWhole / 2, Mixture::kWhole / 2}));
};

// Writes which values are not 0; or reads it, and makes the values 0 and 1. Each pixel is predicted from the
// pixels around it that came before, as in JBIG: from the nearest ten, and from the nearest sixteen.
void code_mask(HeightPicture& picture, BitCoder& coder) {
  MaskModel model;
  std::size_t at = 0;
  for (int y = 0; y < picture.height; ++y) {
    const std::size_t after = at + static_cast<std::size_t>(picture.width);
    if (picture.values.size() < after) picture.values.resize(after);
    for (int x = 0; x < picture.width; ++x, ++at) {
      const bool bit = model.code(picture.values[at] != 0, bits_around(picture, x, y), coder);
      if (bit != (picture.values[at] != 0)) picture.values[at] = bit ? 1 : 0;
    }
  }
}

constexpr std::uint64_t kSides = kMostHeightPictureSide + 1;
constexpr std::uint64_t kValues = 65536;

HeightRange height_range(const HeightPicture& picture) {
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

void encode_one(const HeightPicture& picture, Prediction prediction, RangeEncoder& encoder) {
  encoder.encode_uniform(static_cast<std::uint64_t>(picture.width), kSides);
  encoder.encode_uniform(static_cast<std::uint64_t>(picture.height), kSides);
  HeightPicture copy = picture;
  BitCoder coder(encoder);
  code_mask(copy, coder);
  if (!has_heights(copy)) return;
  const HeightRange range = height_range(copy);
  encoder.encode_uniform(static_cast<std::uint64_t>(range.low), kValues);
  encoder.encode_uniform(static_cast<std::uint64_t>(range.high), kValues);
  code_heights(copy, range, prediction, coder);
}

// Reads what follows the sides of a picture.
void decode_one(HeightPicture& picture, Prediction prediction, RangeDecoder& decoder) {
  BitCoder coder(decoder);
  code_mask(picture, coder);
  if (!has_heights(picture)) return;
  HeightRange range;
  range.low = static_cast<int>(decoder.decode_uniform(kValues));
  range.high = static_cast<int>(decoder.decode_uniform(kValues));
  if (range.low < 1 || range.low > range.high) throw DamagedStream();
  code_heights(picture, range, prediction, coder);
}

int decode_side(RangeDecoder& decoder) { return static_cast<int>(decoder.decode_uniform(kSides)); }

// A large picture is cut into bands of rows, each a stream of its own, so that several threads can code it.
constexpr std::size_t kMostBandPixels = std::size_t{1} << 20;
constexpr int kBands = 8;

// The band's rows of a picture, without values.
HeightPicture band_layout(const HeightPicture& picture, int band) {
  const auto row = [&](int number) { return picture.height * number / kBands; };
  return {picture.width, row(band + 1) - row(band), {}};
}

std::array<std::string, kBands> encoded_bands(const HeightPicture& picture) {
  std::array<HeightPicture, kBands> bands;
  auto from = picture.values.begin();
  for (int b = 0; b < kBands; ++b) {
    HeightPicture& band = bands[static_cast<std::size_t>(b)] = band_layout(picture, b);
    const auto end = from + static_cast<std::ptrdiff_t>(band.pixels());
    band.values.assign(from, end);
    from = end;
  }
  std::array<std::string, kBands> streams;
  parallel_for(0, kBands, [&](std::int64_t number) {
    const auto b = static_cast<std::size_t>(number);
    RangeEncoder encoder;
    encode_one(bands[b], Prediction::kQuick, encoder);
    streams[b] = encoder.finish();
  });
  return streams;
}

void decode_bands(const std::array<std::string, kBands>& streams, HeightPicture& picture) {
  std::array<HeightPicture, kBands> bands;
  parallel_for(0, kBands, [&](std::int64_t number) {
    const auto b = static_cast<std::size_t>(number);
    HeightPicture& band = bands[b] = band_layout(picture, static_cast<int>(b));
    RangeDecoder decoder(streams[b]);
    if (decode_side(decoder) != band.width || decode_side(decoder) != band.height) throw DamagedStream();
    decode_one(band, Prediction::kQuick, decoder);
  });
  for (const HeightPicture& band : bands)
    picture.values.insert(picture.values.end(), band.values.begin(), band.values.end());
}

}  // namespace

void encode(const HeightPicture& picture, RangeEncoder& encoder) {
  if (picture.pixels() <= kMostBandPixels) return encode_one(picture, Prediction::kClose, encoder);
  // No picture of one stream has rows without columns.
  encoder.encode_uniform(0, kSides);
  encoder.encode_uniform(kBands, kSides);
  encoder.encode_uniform(static_cast<std::uint64_t>(picture.width), kSides);
  encoder.encode_uniform(static_cast<std::uint64_t>(picture.height), kSides);
  for (const std::string& stream : encoded_bands(picture)) {
    encoder.encode_number(stream.size());
    for (const char byte : stream) encoder.encode_uniform(static_cast<std::uint8_t>(byte), 256);
  }
}

HeightPicture decode(std::size_t most_pixels, RangeDecoder& decoder) {
  HeightPicture picture;
  picture.width = decode_side(decoder), picture.height = decode_side(decoder);
  const bool in_bands = picture.width == 0 && picture.height == kBands;
  if (in_bands) picture.width = decode_side(decoder), picture.height = decode_side(decoder);
  if (picture.pixels() > most_pixels) throw DamagedStream();
  if (!in_bands) {
    decode_one(picture, Prediction::kClose, decoder);
    return picture;
  }
  std::array<std::string, kBands> streams;
  for (std::string& stream : streams) {
    for (std::uint64_t left = decoder.decode_number(); left > 0; --left)
      stream += static_cast<char>(decoder.decode_uniform(256));
  }
  decode_bands(streams, picture);
  return picture;
}

}  // namespace astrolith
