// The blend of a relief's heights at many samples at once, and its transpose: sums over the samples around
// each place. Neither stores the shares of a sample, which its place in the cell says.
#pragma once

#include <algorithm>
#include <array>
#include <cstdint>
#include <vector>

#include "estimation/shape/relief/relief_samples.h"

namespace astrolith {

// The number of the square of places around a point in its cell; points of one square read the same places.
inline int square_of(const std::array<float, 3>& at) {
  const auto along = [](float x) { return std::min(static_cast<int>(x), kReliefCell - 1); };
  return along(at[0]) + kReliefCell * (along(at[1]) + kReliefCell * along(at[2]));
}

// The sum of weight times B (recipe/relief_layer.h) over the places around a point.
float weight_around(const float* weights, const std::array<std::int32_t, 3>& tiles,
                    const std::array<float, 3>& at);

// What is summed over samples: share times this.
enum class SampleSum {
  kOne,     // 1
  kShare,   // the share itself
  kHeight,  // the height of the sample
  kBlend,   // the blend of the heights at the sample
  kError    // the height of the sample less the blend
};

// Length units.
struct HeightRange {
  float least, greatest;
};

class ReliefBlend {
 public:
  // The samples must outlive this.
  explicit ReliefBlend(const ReliefSamples& samples);

  // (places) The sums over all samples, in an order that does not depend on threads. Without heights all are
  // 0.
  std::vector<double> sums(SampleSum of, const std::vector<double>& heights) const;

  // (places) The range of the heights of the samples around each place; {0, 0} without samples.
  std::vector<HeightRange> ranges() const;

  // The mean over the samples of |height of the sample - blend of the heights|, length units.
  double mean_residual(const std::vector<double>& heights) const;

 private:
  std::vector<double> read_cells(SampleSum of, const std::vector<double>& heights,
                                 std::vector<float>& sums) const;

  const ReliefSamples& samples_;
  std::vector<std::uint32_t> first_;  // (places + 1) of `slots_`
  std::vector<std::uint32_t> slots_;  // where a place lies in the tiles
};

}  // namespace astrolith
