// Seconds that the processor has spent on the calling thread. Other programs on the machine do not change
// them.
#pragma once

#include <ctime>

namespace astrolith {

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

}  // namespace astrolith
