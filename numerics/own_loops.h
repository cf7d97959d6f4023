// Work whose parallel loops are its own: on one thread, or apart from those of other work.
#pragma once

#include <tbb/task_arena.h>

namespace astrolith {

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
