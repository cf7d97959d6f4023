// The parallel loop for the thread sanitizer. The sanitizer sees how the threads of the standard library wait
// for each other. It does not see this of oneTBB, whose library is not built for it, and would report every
// loop.
#pragma once

#include <tbb/global_control.h>

#include <algorithm>
#include <atomic>
#include <cstdint>
#include <exception>
#include <mutex>
#include <thread>
#include <vector>

namespace astrolith {

// What parallel_for() promises, by at most four threads at a time, and by no more than ThreadLimit allows.
template <typename Body>
void plain_parallel_for(std::int64_t begin, std::int64_t end, const Body& body, std::int64_t grain) {
  const auto allowed = static_cast<std::int64_t>(
      tbb::global_control::active_value(tbb::global_control::max_allowed_parallelism));
  const std::int64_t step = std::max<std::int64_t>(grain, 1), tasks = (end - begin + step - 1) / step;
  std::atomic<std::int64_t> next{begin};
  std::exception_ptr error;
  std::mutex errors;
  const auto work = [&] {
    try {
      for (std::int64_t first = next.fetch_add(step); first < end; first = next.fetch_add(step)) {
        for (std::int64_t i = first; i < std::min(first + step, end); ++i) body(i);
      }
    } catch (...) {
      const std::lock_guard<std::mutex> lock(errors);
      if (!error) error = std::current_exception();
      next = end;
    }
  };
  {
    std::vector<std::jthread> others;
    for (std::int64_t i = 1; i < std::min({tasks, allowed, std::int64_t{4}}); ++i) others.emplace_back(work);
    work();
  }
  if (error) std::rethrow_exception(error);
}

}  // namespace astrolith
