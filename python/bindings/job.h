// Long work called from Python: it runs in a thread of its own without the interpreter's lock, while the
// calling thread passes progress on and looks for Ctrl-C.
#pragma once

#include <nanobind/nanobind.h>
#include <tbb/task_arena.h>

#include <atomic>
#include <condition_variable>
#include <exception>
#include <functional>
#include <memory>
#include <mutex>
#include <optional>
#include <string>
#include <string_view>
#include <thread>
#include <utility>

#include "numerics/progress.h"

namespace astrolith::python {

// What the two threads of a job share.
class JobState {
 public:
  // The callback that the work calls, for one of its stages.
  Progress progress(const std::string& stage);
  bool stopped() const { return stop_; }

  void finish(std::exception_ptr error);
  void stop() { stop_ = true; }
  // Waits for the end of the work. Returns whether it has ended.
  bool wait(std::chrono::milliseconds time);
  std::exception_ptr error() const { return error_; }
  // The progress since the last call; none where nothing is new.
  std::optional<std::pair<double, std::string>> news();

 private:
  std::mutex mutex_;
  std::condition_variable ended_;
  std::atomic<bool> stop_{false};
  bool done_ = false, new_ = false;
  double fraction_ = 0.0;
  std::string words_;
  std::exception_ptr error_;
};

// Runs `work` in a thread. Calls `callback`, where it is not None, with the fraction done and a few words.
// Where Ctrl-C was pressed, or the callback raised an exception or returned False, the work is asked to stop
// and the exception is raised within a second. Work that has not ended by then goes on in the background
// until its next look at the progress, which is why it must own all that it uses. `must_end` is for work that
// borrows: it is waited for.
void run(const std::shared_ptr<JobState>& state, nanobind::object callback, int threads,
         std::function<void()> work, bool must_end);

// Waits for the work that goes on in the background. The interpreter calls it at its end.
void join_background_work();

// Runs work(state), which returns a result, with at most `threads` threads; 0: all.
template <typename Work>
auto run_job(nanobind::object callback, int threads, Work work, bool must_end = false) {
  using Result = decltype(work(std::declval<JobState&>()));
  auto state = std::make_shared<JobState>();
  auto result = std::make_shared<std::optional<Result>>();
  run(
      state, std::move(callback), threads,
      [state, result, work = std::move(work)]() mutable { result->emplace(work(*state)); }, must_end);
  return std::move(**result);
}

// The message with the options that it names as Python names them: "max_memory" for "--max-memory".
std::string python_words(std::string message);

// Declares what all modules of the package have: exceptions, and the wait at the interpreter's end.
void declare_common(nanobind::module_& module);

// Declares run_program(words), which does what main() of the program words[0] does, and programs(), the
// names. Each module has its own list of programs (programs.cpp.in).
void declare_programs(nanobind::module_& module);

}  // namespace astrolith::python
