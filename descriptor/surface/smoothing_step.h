// One step of Gaussian smoothing over the points of an evened surface. Repeated steps make its scale space.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "descriptor/surface/evened_surface.h"
#include "numerics/parallel_for.h"

namespace astrolith {

inline constexpr double kStepDeviation = 0.8;  // edges

struct SmoothingShare {
  std::uint32_t point;
  double share;
};

// A table of each point's neighbours and their shares of its mean. A step is a mean over the points within
// 2.2 edges with weights near 1 - d^2 / (2.2 edges)^2, whose deviation is kStepDeviation; n steps have the
// deviation sqrt(n) kStepDeviation. Points that look away lie on another side of a thin body and do not
// count. Near the border of an open mesh the means lean inwards.
class SmoothingStep {
 public:
  explicit SmoothingStep(const EvenedSurface& even);

  // The neighbours of a point, and last the point itself.
  std::span<const SmoothingShare> around(std::size_t i) const {
    return {&shares_[starts_[i]], starts_[i + 1] - starts_[i]};
  }

  template <typename Value>
  std::vector<Value> operator()(const std::vector<Value>& values) const {
    constexpr std::int64_t kGrain = 512;
    std::vector<Value> means(values.size());
    parallel_for(
        0, static_cast<std::int64_t>(values.size()),
        [&](std::int64_t index) {
          const auto i = static_cast<std::size_t>(index);
          Value mean{};
          for (const SmoothingShare& s : around(i)) mean += s.share * values[s.point];
          means[i] = mean;
        },
        kGrain);
    return means;
  }

 private:
  std::vector<std::size_t> starts_;
  std::vector<SmoothingShare> shares_;
};

}  // namespace astrolith
