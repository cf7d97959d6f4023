#include "recipe/compact/height_mask_internal.h"

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

}  // namespace

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

}  // namespace astrolith
