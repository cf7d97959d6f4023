// Long work whose parts run on several threads, and a caller who is told of it and may stop it.
#pragma once

#include <atomic>
#include <chrono>
#include <future>
#include <string_view>

#include "numerics/progress.h"

namespace astrolith {

// Calls work(heed) on a thread of its own, and reports to `progress` from the caller's thread twenty times a
// second meanwhile. `heed` is a Progress that any thread may call: it keeps the fraction for the next report
// and returns false once progress has asked to stop. What work throws is thrown here. Without a progress the
// work is called at once, with none.
template <typename Work>
void watched_work(const Progress& progress, std::string_view words, const Work& work) {
  if (!progress) {
    work(Progress{});
    return;
  }
  std::atomic<bool> goes_on{true};
  std::atomic<double> fraction{0.0};
  std::future<void> done = std::async(std::launch::async, [&] {
    work([&](double done_so_far, std::string_view) {
      fraction = done_so_far;
      return goes_on.load();
    });
  });
  while (done.wait_for(std::chrono::milliseconds(50)) != std::future_status::ready) {
    if (!report(progress, fraction, words)) goes_on = false;
  }
  done.get();
}

}  // namespace astrolith
