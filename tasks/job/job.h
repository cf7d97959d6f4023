// A job at work: what it takes from its caller, and what it tells the caller. A job is a function of the
// tasks, such as fit_shape(), with a table of options. A program and a function of the Python package are
// each a job with another caller.
#pragma once

#include <chrono>
#include <cstdint>
#include <functional>
#include <memory>
#include <mutex>
#include <nlohmann/json.hpp>
#include <set>
#include <string>
#include <string_view>

#include "numerics/processor_clock.h"
#include "numerics/progress.h"
#include "tasks/job/option_table.h"

namespace astrolith {

// The work of a job whose options have been declared.
using JobWork = std::function<void()>;

class Job {
  std::unique_ptr<OptionTable> own_options_;  // none where the job is a part of another

 public:
  // Declares --seed, which all jobs take.
  explicit Job(std::string name);
  Job(const Job&) = delete;
  Job& operator=(const Job&) = delete;
  virtual ~Job() = default;

  // The callback of a stage of the work. It returns false once the caller asks the work to stop.
  virtual Progress progress(std::string stage) const = 0;
  // True once the caller has asked the work to stop. The job then ends with its best so far.
  virtual bool stopped() const = 0;
  // A stop will be answered by a result, however long that takes to write. Other work is ended where it
  // stands if it has not ended half a second after a stop.
  virtual void keep_best_so_far() {}
  // What asked: "Ctrl-C", for instance.
  virtual const char* stopped_by() const = 0;
  // Tells a person one line.
  virtual void say(const std::string& line) const = 0;
  // Tells a person the line once the work is done. Work that fails tells no notes.
  virtual void note(const std::string& line) = 0;
  // Tells a note that has not been told by this function yet. Parts of the work call it beside each other.
  void note_once(const std::string& line) {
    const std::lock_guard lock(parts_mutex_);
    if (noted_.insert(line).second) note(line);
  }
  // Hands over the text of a result, at once. Throws WorkError where nobody takes it any more.
  virtual void print_result(const std::string& text) = 0;
  // Reports a part of the work that failed while the rest goes on.
  virtual void report_failure(const std::string& line) = 0;

  // Wall-clock seconds since the work began.
  double seconds() const {
    return std::chrono::duration<double>(std::chrono::steady_clock::now() - start_).count();
  }
  // Seconds of all processors since the work began.
  double processor_seconds() const { return astrolith::processor_seconds() - processor_start_; }
  StageProgress stages() const {
    return [this](const std::string& stage) { return progress(stage); };
  }
  // "fit_shape 0.2.0 (1a2b3c4)", for provenance.
  std::string tool() const;

  OptionTable& options;
  nlohmann::ordered_json summary;
  std::uint64_t seed = 1;
  bool quiet = false;  // the job tells nothing but failures

 protected:
  struct Whole {
    Job& job;
  };
  // A part of a job: it has the options, the seed and the clock of the whole.
  explicit Job(Whole whole)
      : options(whole.job.options),
        seed(whole.job.seed),
        name_(whole.job.name_),
        start_(whole.job.start_),
        processor_start_(whole.job.processor_start_) {}

  std::string name_;
  std::chrono::steady_clock::time_point start_ = std::chrono::steady_clock::now();
  double processor_start_ = astrolith::processor_seconds();

 private:
  std::mutex parts_mutex_;
  std::set<std::string> noted_;  // by parts
};

// A part of a job with a summary of its own, which tells nothing but failures and notes. Parts may work
// beside each other. A note of several parts is told once.
class JobPart : public Job {
 public:
  explicit JobPart(Job& whole) : Job(Whole{whole}), whole_(whole) { quiet = true; }

  Progress progress(std::string) const override {
    return [this](double, std::string_view) { return !stopped(); };
  }
  bool stopped() const override { return whole_.stopped(); }
  const char* stopped_by() const override { return whole_.stopped_by(); }
  void say(const std::string&) const override {}
  void note(const std::string& line) override { whole_.note_once(line); }
  void print_result(const std::string&) override {}
  void report_failure(const std::string& line) override { whole_.report_failure(line); }

 private:
  Job& whole_;
};

}  // namespace astrolith
