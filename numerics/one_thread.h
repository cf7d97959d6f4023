// Work that is to be timed by the clock of one thread.
#pragma once

#include <tbb/task_arena.h>

namespace astrolith {

// Calls body() with all parallel loops inside it on the calling thread. The thread sanitizer's loops have
// threads nevertheless.
template <typename Body>
void on_one_thread(const Body& body) {
  tbb::task_arena arena(1);
  arena.execute(body);
}

}  // namespace astrolith
