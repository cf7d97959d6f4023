// oneTBB's arena, whose work is always the calling thread's here.
#pragma once

namespace tbb {

class task_arena {
 public:
  explicit task_arena(int /*threads*/) {}
  template <typename Body>
  void execute(const Body& body) {
    body();
  }
};

namespace this_task_arena {
template <typename Body>
void isolate(const Body& body) {
  body();
}
}  // namespace this_task_arena

}  // namespace tbb
