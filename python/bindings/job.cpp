#include "python/bindings/job.h"

#include <dlfcn.h>
#include <nanobind/stl/string.h>
#include <sys/types.h>
#include <unistd.h>

#include <algorithm>
#include <atomic>
#include <chrono>
#include <cstdlib>
#include <filesystem>
#include <list>
#include <regex>

#include "numerics/errors.h"
#include "numerics/files/input_file.h"
#include "numerics/printable_text.h"
#include "numerics/process_limits.h"

namespace nb = nanobind;

namespace astrolith::python {
namespace {

using namespace std::chrono_literals;

// How often the calling thread looks for signals and progress.
constexpr auto kLookEvery = 30ms;
// How long work may take to stop before the caller goes on without it.
constexpr auto kPatience = 700ms;

// Threads of work that was asked to stop and had not ended when its caller went on.
struct Background {
  std::mutex mutex;
  std::list<std::pair<std::shared_ptr<JobState>, std::thread>> jobs;
};
// Never destroyed: threads may outlive the module's static objects.
Background& background() {
  static auto* all = new Background;
  return *all;
}

void forget_ended_work() {
  const std::lock_guard lock(background().mutex);
  background().jobs.remove_if([](auto& job) {
    if (!job.first->wait(0ms)) return false;
    job.second.join();
    return true;
  });
}

// Raises the exception of a signal, or of the callback. A callback that returns False asks to stop.
void look_up(JobState& state, const nb::object& callback) {
  if (PyErr_CheckSignals() != 0) throw nb::python_error();
  if (callback.is_none()) return;
  const auto news = state.news();
  if (!news) return;
  if (callback(news->first, news->second).is(nb::handle(Py_False))) state.stop();
}

// A process that is forked from one at work lacks its threads, for which TBB would wait for ever.
void require_own_threads() {
  static std::atomic<pid_t> first{0};
  pid_t seen = 0;
  if (first.compare_exchange_strong(seen, ::getpid()) || seen == ::getpid()) return;
  throw WorkError(
      "this process was forked from one that had used astrolith, and lacks its threads; start workers by "
      "spawn "
      "(multiprocessing.get_context(\"spawn\"))");
}

}  // namespace

Progress JobState::progress(const std::string& stage) {
  return [this, stage](double fraction, std::string_view words) {
    const std::lock_guard lock(mutex_);
    fraction_ = fraction;
    words_ = words.empty() ? stage : stage + ": " + std::string(words);
    new_ = true;
    return !stop_;
  };
}

void JobState::finish(std::exception_ptr error) {
  const std::lock_guard lock(mutex_);
  error_ = std::move(error);
  done_ = true;
  ended_.notify_all();
}

bool JobState::wait(std::chrono::milliseconds time) {
  std::unique_lock lock(mutex_);
  return ended_.wait_for(lock, time, [&] { return done_; });
}

std::optional<std::pair<double, std::string>> JobState::news() {
  const std::lock_guard lock(mutex_);
  if (!std::exchange(new_, false)) return std::nullopt;
  return std::pair(fraction_, printable(words_));
}

void run(const std::shared_ptr<JobState>& state, nb::object callback, int threads, std::function<void()> work,
         bool must_end) {
  if (!callback.is_none() && !PyCallable_Check(callback.ptr())) {
    throw nb::type_error("progress: must be a function of a share and a text, or None");
  }
  require_own_threads();
  forget_ended_work();
  std::thread worker([state, threads, work = std::move(work)]() mutable {
    std::exception_ptr error;
    try {
      tbb::task_arena(threads > 0 ? threads : usable_processors()).execute(work);
    } catch (...) {
      error = std::current_exception();
    }
    work = nullptr;
    state->finish(error);
  });
  const auto ended_within = [&](std::chrono::milliseconds time) {
    const nb::gil_scoped_release release;
    return state->wait(time);
  };
  try {
    while (!ended_within(kLookEvery)) look_up(*state, callback);
    worker.join();
    if (state->error()) std::rethrow_exception(state->error());
    if (!callback.is_none()) look_up(*state, callback);
  } catch (...) {
    state->stop();
    if (worker.joinable()) {
      while (!ended_within(kPatience) && must_end) {
      }
      const std::lock_guard lock(background().mutex);
      background().jobs.emplace_back(state, std::move(worker));
    }
    throw;
  }
}

void join_background_work() {
  const nb::gil_scoped_release release;
  const std::lock_guard lock(background().mutex);
  for (auto& [state, thread] : background().jobs) thread.join();
  background().jobs.clear();
}

std::string python_words(std::string message) {
  static const std::regex option("--([a-z][a-z0-9-]*)");
  std::string words;
  for (std::smatch found; std::regex_search(message, found, option); message = found.suffix()) {
    std::string name = found[1];
    std::replace(name.begin(), name.end(), '-', '_');
    words += found.prefix().str() + name;
  }
  return words + message;
}

namespace {

// Gives pictures the font that lies beside this module in a wheel, on a system that names none.
void use_own_font() {
  Dl_info own;
  if (dladdr(reinterpret_cast<const void*>(&use_own_font), &own) == 0) return;
  const std::filesystem::path fonts =
      std::filesystem::path(own.dli_fname).parent_path() / "share/astrolith/fonts/fonts.conf";
  if (!std::filesystem::exists("/etc/fonts/fonts.conf") && std::filesystem::exists(fonts))
    setenv("FONTCONFIG_FILE", fonts.c_str(), 0);
}

}  // namespace

void declare_common(nb::module_& module) {
  use_own_font();
  nb::register_exception_translator([](const std::exception_ptr& error, void*) {
    try {
      std::rethrow_exception(error);
    } catch (const MissingFileError& e) {
      const nb::object type = nb::module_::import_("astrolith._arrays").attr("MissingFileError");
      PyErr_SetString(type.ptr(), printable(e.what()).c_str());
    } catch (const InputError& e) {
      PyErr_SetString(PyExc_ValueError, printable(python_words(e.what())).c_str());
    } catch (const WorkError& e) {
      PyErr_SetString(PyExc_RuntimeError, printable(python_words(e.what())).c_str());
    }
  });
  module.def("join_background_work", &join_background_work,
             "Waits for work that was stopped and has not ended yet.");
  nb::module_::import_("atexit").attr("register")(module.attr("join_background_work"));
}

}  // namespace astrolith::python
