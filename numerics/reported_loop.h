// The parallel loop of long work that reports its progress and stops when asked to.
#pragma once

#include <algorithm>
#include <chrono>
#include <cstdint>
#include <string>
#include <string_view>
#include <thread>

#include "numerics/errors.h"
#include "numerics/parallel_for.h"
#include "numerics/progress.h"

namespace astrolith {

// A stretch of the work: indices [begin, end) of `total`.
struct ReportedRange {
  std::int64_t begin = 0, end = 0, total = 0;
};

// The callback for a preparation that is short beside the work that follows: the fraction stays 0.
inline Progress at_beginning(const Progress& progress) {
  if (!progress) return {};
  return [progress](double, std::string_view words) { return progress(0, words); };
}

// Calls body(i) for every i of the range and reports the fraction of `total` that is done about every tenth
// of a second. Throws WorkError when progress asks to stop. The clock decides only how many indices lie
// between two reports.
template <typename Body>
void reported_parallel_for(const ReportedRange& range, const Progress& progress, std::string_view words,
                           const Body& body) {
  if (!progress) return parallel_for(range.begin, range.end, body);
  using Clock = std::chrono::steady_clock;
  const std::int64_t fewest = std::max<std::int64_t>(std::thread::hardware_concurrency(), 1);
  std::int64_t count = fewest;
  for (std::int64_t begin = range.begin; begin < range.end;) {
    const std::int64_t end = std::min(begin + count, range.end);
    const auto start = Clock::now();
    parallel_for(begin, end, body);
    const std::chrono::duration<double> seconds = Clock::now() - start;
    if (seconds.count() < 0.05) count *= 2;
    if (seconds.count() > 0.2) count = std::max(count / 2, fewest);
    begin = end;
    if (!report(progress, static_cast<double>(end) / static_cast<double>(range.total), words)) {
      throw WorkError(std::string(words) + ": stopped");
    }
  }
}

}  // namespace astrolith
