#include "recipe/compact/height_picture.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <string>

#include "numerics/files/sha256.h"
#include "numerics/hash_random.h"

namespace astrolith {
namespace {

std::string encode_bytes(const HeightPicture& picture) {
  RangeEncoder encoder;
  encode(picture, encoder);
  return encoder.finish();
}

HeightPicture decode_picture(const std::string& bytes, std::size_t most_pixels = std::size_t{1} << 24) {
  RangeDecoder decoder(bytes);
  return decode(most_pixels, decoder);
}

void expect_equal_after_coding(const HeightPicture& picture) {
  const HeightPicture decoded = decode_picture(encode_bytes(picture));
  EXPECT_EQ(decoded.width, picture.width);
  EXPECT_EQ(decoded.height, picture.height);
  EXPECT_EQ(decoded.values, picture.values);
}

template <class Value>
HeightPicture make_picture(int width, int height, const Value& value) {
  HeightPicture picture{width, height, {}};
  for (int y = 0; y < height; ++y) {
    for (int x = 0; x < width; ++x) picture.values.push_back(static_cast<std::uint16_t>(value(x, y)));
  }
  return picture;
}

// Whether a pixel is in one of six discs, 80 pixels wide, in a picture of 300 x 200 pixels.
bool in_a_disc(int x, int y) {
  const int dx = x % 100 - 50, dy = y % 100 - 50;
  return dx * dx + dy * dy < 1600;
}

int noise(std::uint32_t seed, int x, int y, int below) {
  return static_cast<int>(hash_cell(seed, x, y, 0) % static_cast<std::uint32_t>(below));
}

// Noise on a grid of squares of `side` pixels, between which it is bilinear.
int smooth_noise(std::uint32_t seed, int x, int y, int side, int below) {
  const int column = x / side, row = y / side, right = x % side, down = y % side;
  const auto corner = [&](int dx, int dy) { return noise(seed, column + dx, row + dy, below); };
  const int upper = corner(0, 0) * (side - right) + corner(1, 0) * right;
  const int lower = corner(0, 1) * (side - right) + corner(1, 1) * right;
  return (upper * (side - down) + lower * down) / (side * side);
}

// The six discs show a terrain of about a hundred steps, with noise.
HeightPicture terrain(int width = 300, int height = 200) {
  return make_picture(width, height, [](int x, int y) {
    if (!in_a_disc(x, y)) return 0;
    const int hills = smooth_noise(1, x, y, 25, 70) + smooth_noise(2, x, y, 10, 30);
    return 32700 + hills + noise(3, x, y, 4);
  });
}

// The prediction of LOCO-I from the pixels left, above and above left, as far as they have a height.
int median_edge_prediction(const HeightPicture& picture, int x, int y) {
  const auto at = [&](int dx, int dy) -> int {
    if (x < dx || y < dy) return 0;
    return picture.values[static_cast<std::size_t>((y - dy) * picture.width + x - dx)];
  };
  const int left = at(1, 0), above = at(0, 1), corner = at(1, 1);
  if (left == 0 || above == 0 || corner == 0) return std::max(left, above);
  return std::clamp(left + above - corner, std::min(left, above), std::max(left, above));
}

// The bytes that the errors of this prediction take by their entropy, without the mask and without a table.
double median_edge_bytes(const HeightPicture& picture) {
  std::map<int, double> counts;
  double all = 0.0;
  for (int y = 0; y < picture.height; ++y) {
    for (int x = 0; x < picture.width; ++x) {
      const int value = picture.values[static_cast<std::size_t>(y * picture.width + x)];
      if (value == 0) continue;
      ++counts[value - median_edge_prediction(picture, x, y)];
      ++all;
    }
  }
  double bits = 0.0;
  for (const auto& [error, count] : counts) bits += count * std::log2(all / count);
  return bits / 8.0;
}

TEST(RangeCoder, AStreamCanBeginWithTheByte255) {
  RangeEncoder encoder;
  for (const std::uint64_t value : {4096u, 4096u, 7u}) encoder.encode_uniform(value, 4097);
  const std::string bytes = encoder.finish();
  RangeDecoder decoder(bytes);
  for (const std::uint64_t value : {4096u, 4096u, 7u}) EXPECT_EQ(decoder.decode_uniform(4097), value);
}

TEST(HeightPicture, SmallPicturesAreHeld) {
  expect_equal_after_coding({});
  expect_equal_after_coding({0, 7, {}});
  expect_equal_after_coding({7, 0, {}});
  for (const std::uint16_t value : {0, 1, 32768, 65535}) expect_equal_after_coding({1, 1, {value}});
  expect_equal_after_coding({5, 1, {0, 9, 8, 0, 7}});
  expect_equal_after_coding({1, 5, {0, 9, 8, 0, 7}});
  expect_equal_after_coding({4, 1, {65535, 1, 1, 65535}});
}

TEST(HeightPicture, PlainPicturesTakeFewBytes) {
  const HeightPicture holes = make_picture(200, 150, [](int, int) { return 0; });
  const HeightPicture plain = make_picture(200, 150, [](int, int) { return 40000; });
  const HeightPicture ramp = make_picture(200, 150, [](int x, int y) { return 30000 + 3 * x + 2 * y; });
  for (const HeightPicture& picture : {holes, plain, ramp}) expect_equal_after_coding(picture);
  EXPECT_LT(encode_bytes(holes).size(), 20u);
  EXPECT_LT(encode_bytes(plain).size(), 40u);
  EXPECT_LT(encode_bytes(ramp).size(), 400u);
}

TEST(HeightPicture, NoiseTakesHardlyMoreThanItsBits) {
  const HeightPicture values = make_picture(100, 80, [](int x, int y) { return 1 + noise(5, x, y, 65535); });
  expect_equal_after_coding(values);
  EXPECT_LT(static_cast<double>(encode_bytes(values).size()), 1.08 * 16000.0);
  const HeightPicture mask = make_picture(200, 80, [](int x, int y) { return noise(6, x, y, 2) * 5; });
  expect_equal_after_coding(mask);
  EXPECT_LT(static_cast<double>(encode_bytes(mask).size()), 1.2 * 2000.0);
}

TEST(HeightPicture, ExtremesBesideEachOtherAreHeld) {
  expect_equal_after_coding(
      make_picture(64, 64, [](int x, int y) { return noise(7, x, y, 2) == 0 ? 1 : 65535; }));
  expect_equal_after_coding(make_picture(
      64, 64, [](int x, int y) { return noise(8, x, y, 3) == 0 ? 0 : 1 + noise(9, x, y, 2) * 65534; }));
  expect_equal_after_coding(make_picture(kMostHeightPictureSide, 2, [](int x, int) { return x * 16; }));
}

TEST(HeightPicture, TerrainTakesFewerBytesThanMedianEdgePrediction) {
  const HeightPicture picture = terrain();
  expect_equal_after_coding(picture);
  EXPECT_LT(static_cast<double>(encode_bytes(picture).size()), 0.9 * median_edge_bytes(picture));
}

TEST(HeightPicture, BytesAreFixed) {
  const std::string bytes = encode_bytes(terrain());
  Sha256 hash;
  hash.update(bytes.data(), bytes.size());
  EXPECT_EQ(hash.hex(), "0879ab679a23f345f25f7d7dacfe0b5496af6cdff84e481e933b0f5f9250aa80");
}

TEST(HeightPicture, MorePixelsThanAskedForAreRefused) {
  const std::string bytes = encode_bytes(terrain());
  EXPECT_EQ(decode_picture(bytes, 60000).pixels(), 60000u);
  EXPECT_THROW(decode_picture(bytes, 59999), DamagedStream);
}

// A decoder may take bytes for another picture, but never for one beyond the limits.
void expect_an_end(const std::string& bytes) {
  try {
    const HeightPicture picture = decode_picture(bytes);
    EXPECT_EQ(picture.values.size(), picture.pixels());
  } catch (const DamagedStream&) {
  }
}

TEST(HeightPicture, CutStreamsEnd) {
  const std::string bytes = encode_bytes(terrain(100, 100));
  for (std::size_t size = 0; size < bytes.size(); size += 197) expect_an_end(bytes.substr(0, size));
  EXPECT_THROW(decode_picture(bytes.substr(0, bytes.size() / 2)), DamagedStream);
}

TEST(HeightPicture, DamagedStreamsEnd) {
  const std::string bytes = encode_bytes(terrain(100, 100));
  CounterRandom random(5);
  for (int i = 0; i < 40; ++i) {
    std::string changed = bytes;
    changed[random.below(bytes.size() / 4)] ^= static_cast<char>(1 + random.below(255));
    expect_an_end(changed);
  }
}

TEST(HeightPicture, RandomBytesEnd) {
  CounterRandom random(6);
  for (int i = 0; i < 400; ++i) {
    std::string bytes;
    for (std::uint64_t size = random.below(200); size > 0; --size)
      bytes += static_cast<char>(random.below(256));
    expect_an_end(bytes);
  }
}

// A ball in the middle of holes, larger than what one stream holds.
TEST(HeightPicture, LargePicturesAreHeldInBands) {
  const HeightPicture ball = make_picture(2048, 520, [](int x, int y) {
    const int squared = (x - 400) * (x - 400) + (y - 260) * (y - 260);
    return squared < 10000 ? 5000 + squared / 8 + noise(10, x, y, 9) : 0;
  });
  expect_equal_after_coding(ball);
  const std::string bytes = encode_bytes(ball);
  EXPECT_THROW(decode_picture(bytes, ball.pixels() - 1), DamagedStream);
  EXPECT_THROW(decode_picture(bytes.substr(0, bytes.size() / 2)), DamagedStream);
  CounterRandom random(7);
  for (int i = 0; i < 10; ++i) {
    std::string changed = bytes;
    changed[random.below(bytes.size())] ^= static_cast<char>(1 + random.below(255));
    expect_an_end(changed);
  }
}

// 4096 x 4096 pixels whose mask no byte follows.
TEST(HeightPicture, AFewBytesHoldAFewPixels) {
  RangeEncoder encoder;
  encoder.encode_uniform(kMostHeightPictureSide, kMostHeightPictureSide + 1);
  encoder.encode_uniform(kMostHeightPictureSide, kMostHeightPictureSide + 1);
  EXPECT_THROW(decode_picture(encoder.finish()), DamagedStream);
}

}  // namespace
}  // namespace astrolith
