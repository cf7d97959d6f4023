// fit_shape's --time-limit: each stage of a fit gets a share of the time.
#pragma once

#include <algorithm>
#include <atomic>
#include <chrono>
#include <string>
#include <string_view>
#include <utility>

#include "numerics/progress.h"

namespace astrolith {

// Asks a stage to stop when its share of the time, counted from the start of the program's work, is over.
class TimeLimit {
 public:
  explicit TimeLimit(double seconds) : seconds_(seconds) {}

  Progress guard(Progress progress, const std::string& stage) {
    if (seconds_ <= 0.0) return progress;
    const bool last = stage != "pack" && stage != "search";
    const double end = last ? seconds_ - reserve() : seconds_ * (stage == "pack" ? 0.1 : 0.25);
    return [this, last, end, progress = std::move(progress)](double fraction, std::string_view words) {
      const std::chrono::duration<double> spent = std::chrono::steady_clock::now() - start_;
      const bool over = spent.count() > end;
      // When an earlier stage ends, only its own share of the time is over. The fit goes on.
      reached_ = reached_ || (over && last);
      return progress(fraction, words) && !over;
    };
  }
  // Seconds kept for meshing and measuring the result, at most half of all.
  double reserve() const { return std::min(4.0, 0.5 * seconds_); }
  bool reached() const { return reached_; }

 private:
  double seconds_;
  std::chrono::steady_clock::time_point start_ = std::chrono::steady_clock::now();
  std::atomic<bool> reached_{false};
};

}  // namespace astrolith
