// The parallel loop. A body writes to its own index only, and sums are taken afterwards in index order.
// Results then do not depend on the number of threads.
#pragma once

#include <tbb/blocked_range.h>
#include <tbb/global_control.h>
#include <tbb/parallel_for.h>
#include <tbb/task_arena.h>

#include <cstdint>
#include <thread>

#ifdef ASTROLITH_THREAD_SANITIZER
#include "numerics/plain_threads.h"
#endif

namespace astrolith {

// Limits all parallel loops to num_threads threads while it lives; 0 stands for all hardware threads.
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

// The most threads that parallel loops have now.
inline int thread_limit() {
  return static_cast<int>(tbb::global_control::active_value(tbb::global_control::max_allowed_parallelism));
}

// Calls body(i) for every i in [begin, end), in any order and in tasks of about `grain` indices or more. An
// exception that a body throws is rethrown here.
template <typename Body>
void parallel_for(std::int64_t begin, std::int64_t end, const Body& body, std::int64_t grain = 1) {
#ifdef ASTROLITH_THREAD_SANITIZER
  plain_parallel_for(begin, end, body, grain);
#else
  tbb::parallel_for(tbb::blocked_range<std::int64_t>(begin, end, static_cast<std::size_t>(grain)),
                    [&](const tbb::blocked_range<std::int64_t>& range) {
                      for (std::int64_t i = range.begin(); i != range.end(); ++i) body(i);
                    });
#endif
}

// Calls body() with all parallel loops inside it on the calling thread, for work that is to be timed by the
// clock of one thread. The thread sanitizer's loops have threads nevertheless.
template <typename Body>
void on_one_thread(const Body& body) {
  tbb::task_arena arena(1);
  arena.execute(body);
}

// Calls body() so that a thread which waits for a loop inside it takes up nothing of other loops. One work
// beside others would else wait for theirs.
template <typename Body>
void within_own_loops(const Body& body) {
  tbb::this_task_arena::isolate(body);
}

}  // namespace astrolith
