// What small random filters find in square patches: features of texture that nobody chose, each with its
// gradient.
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

namespace astrolith {

// Twelve filters of 2 x 2 to 5 x 5 taps, 1 to 3 samples apart, whose taps have the mean 0. Of the answers of
// a filter, over their root mean square on measured patches, a patch has three features: the logarithm of the
// standard deviation, the largest answer, and the share above a level, with a soft edge.
class PatchFeatures {
 public:
  static constexpr std::size_t kSide = 16, kSamples = kSide * kSide, kFilters = 12, kColumns = 3 * kFilters;

  // `measured` are patches (n x kSamples).
  PatchFeatures(const std::vector<float>& measured, std::uint32_t hash);

  // (n x kColumns) of patches (n x kSamples).
  std::vector<float> of(const std::vector<float>& patches) const;

  // (n x kSamples) The gradient by the patches of the sum of all features times `by` (n x kColumns).
  std::vector<float> gradient(const std::vector<float>& patches, const std::vector<float>& by) const;

 private:
  struct Filter {
    std::size_t side, apart;
    std::vector<float> taps;
    float level;

    std::size_t across() const { return kSide - (side - 1) * apart; }  // answers along a side of a patch
    std::size_t offset(std::size_t tap) const { return apart * (kSide * (tap / side) + tap % side); }
  };
  static Filter draw(std::size_t number, std::uint32_t& hash);
  static std::size_t answer(const Filter& filter, const float* patch, float* answers);
  static void spread(const Filter& filter, const float* by, float* patch);

  std::vector<Filter> filters_;
};

}  // namespace astrolith
