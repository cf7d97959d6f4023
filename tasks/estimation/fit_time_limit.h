// The time limit of a fit of a shape: each stage gets a share of the time.
#pragma once

#include <fmt/format.h>

#include <algorithm>
#include <atomic>
#include <chrono>
#include <string>
#include <string_view>
#include <utility>

#include "numerics/errors.h"
#include "numerics/progress.h"

namespace astrolith {

// Asks a stage to stop when its share of the time, counted from the start of the program's work, is over.
class TimeLimit {
 public:
  // 0 seconds: no limit.
  explicit TimeLimit(double seconds) : seconds_(seconds) {}

  // For the preparation of the mesh, without which there is no result: throws InputError once the time is
  // over. `done` is the share of the preparation that is over when the progress begins, and it ends at 1.
  Progress preparation(double done) const {
    if (seconds_ <= 0.0) return {};
    return [this, done](double fraction, std::string_view) {
      const double share = done + (1.0 - done) * fraction, now = spent();
      if (now <= seconds_) return true;
      throw InputError(
          fmt::format("--time-limit: reading and checking the mesh is {:.0f} % done after {:.2g} s "
                      "and there is nothing to write yet; allow some {:.2g} s, or more for a fit",
                      100.0 * share, now, now / share));
    };
  }

  Progress guard(Progress progress, const std::string& stage) {
    if (seconds_ <= 0.0) return progress;
    const bool last = stage != "pack" && stage != "search";
    const double end = last ? seconds_ - reserve() : seconds_ * (stage == "pack" ? 0.1 : 0.25);
    return [this, last, end, progress = std::move(progress)](double fraction, std::string_view words) {
      const bool over = spent() > end;
      // When an earlier stage ends, only its own share of the time is over. The fit goes on.
      reached_ = reached_ || (over && last);
      return progress(fraction, words) && !over;
    };
  }
  // Seconds kept for meshing and measuring the result, at most half of all.
  double reserve() const { return std::min(4.0, 0.5 * seconds_); }
  // Whether a stage was stopped or left out.
  bool reached() const { return reached_; }
  // Whether there is time for what the result can do without.
  bool has_time_left() const { return seconds_ <= 0.0 || spent() < seconds_ - reserve(); }
  // Whether another stage may begin. If it may not, the limit is reached.
  bool allows_more() {
    reached_ = reached_ || (seconds_ > 0.0 && spent() > seconds_ - reserve());
    return !reached_;
  }

 private:
  double spent() const {
    return std::chrono::duration<double>(std::chrono::steady_clock::now() - start_).count();
  }

  double seconds_;
  std::chrono::steady_clock::time_point start_ = std::chrono::steady_clock::now();
  std::atomic<bool> reached_{false};
};

}  // namespace astrolith
