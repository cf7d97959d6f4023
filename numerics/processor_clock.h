// Seconds of the processor, which other programs on the machine do not change.
#pragma once

#include <ctime>

namespace astrolith {

// Seconds that the processor has spent on the calling thread.
class ProcessorClock {
 public:
  double seconds() const { return now() - start_; }

 private:
  static double now() {
    timespec t{};
    clock_gettime(CLOCK_THREAD_CPUTIME_ID, &t);
    return static_cast<double>(t.tv_sec) + 1e-9 * static_cast<double>(t.tv_nsec);
  }
  double start_ = now();
};

// Seconds that all threads of this process have spent so far.
inline double processor_seconds() { return static_cast<double>(std::clock()) / CLOCKS_PER_SEC; }

}  // namespace astrolith
