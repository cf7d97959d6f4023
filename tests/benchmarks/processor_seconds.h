// Measures seconds of the processor, which other programs on the machine do not add to.
#pragma once

#include <algorithm>
#include <ctime>
#include <limits>

namespace astrolith {

// Seconds of one execution, summed over all its threads.
double processor_seconds(const auto& work) {
  const std::clock_t start = std::clock();
  work();
  return static_cast<double>(std::clock() - start) / CLOCKS_PER_SEC;
}

// The least of five executions.
double least_processor_seconds(const auto& work) {
  double least = std::numeric_limits<double>::infinity();
  for (int repeat = 0; repeat < 5; ++repeat) least = std::min(least, processor_seconds(work));
  return least;
}

}  // namespace astrolith
