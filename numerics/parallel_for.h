// The parallel loop. Bodies write only to their own index, and whoever sums does so afterwards in index
// order: that is all it takes for results that do not depend on the thread count.
#pragma once

#include <tbb/blocked_range.h>
#include <tbb/global_control.h>
#include <tbb/parallel_for.h>

#include <cstdint>
#include <thread>

namespace astrolith {

// Limits all parallel loops to num_threads (0 = every hardware thread) while it lives.
class ThreadLimit {
 public:
  explicit ThreadLimit(int num_threads)
      : control_(tbb::global_control::max_allowed_parallelism,
                 num_threads > 0 ? static_cast<std::size_t>(num_threads)
                                 : std::size_t{std::thread::hardware_concurrency() > 0
                                                   ? std::thread::hardware_concurrency()
                                                   : 1}) {}

 private:
  tbb::global_control control_;
};

// Calls body(i) for i in [begin, end), in any order. The first exception thrown is rethrown.
template <typename Body>
void parallel_for(std::int64_t begin, std::int64_t end, const Body& body, std::int64_t grain = 1) {
  tbb::parallel_for(tbb::blocked_range<std::int64_t>(begin, end, static_cast<std::size_t>(grain)),
                    [&](const tbb::blocked_range<std::int64_t>& range) {
                      for (std::int64_t i = range.begin(); i != range.end(); ++i) body(i);
                    });
}

}  // namespace astrolith
