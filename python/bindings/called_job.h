// A job that Python calls: its options come as words, and what it says becomes remarks of its figures.
#pragma once

#include <nanobind/nanobind.h>
#include <nanobind/stl/filesystem.h>
#include <nanobind/stl/pair.h>
#include <nanobind/stl/string.h>
#include <nanobind/stl/tuple.h>
#include <nanobind/stl/vector.h>

#include <filesystem>
#include <string>
#include <tuple>
#include <utility>
#include <vector>

#include "numerics/errors.h"
#include "python/bindings/job.h"
#include "tasks/job/job.h"

namespace astrolith::python {

// The options that were given, each with the words of its value, as on a command line. Words may be names of
// files that are no UTF-8.
using GivenOptions = std::vector<std::pair<std::string, std::vector<std::filesystem::path>>>;

class CalledJob : public Job {
 public:
  CalledJob(const std::string& program, JobState& state) : Job(program), state_(state) {}

  Progress progress(std::string stage) const override { return state_.progress(stage); }
  bool stopped() const override { return state_.stopped(); }
  const char* stopped_by() const override { return "the caller"; }
  void say(const std::string& line) const override {
    if (!quiet) remarks_.push_back(line);
  }
  void note(const std::string& line) override { say(line); }
  void print_result(const std::string&) override {}  // the figures have it
  void report_failure(const std::string& line) override { remarks_.push_back(line); }

  // Fills the declared options. Throws InputError where a value, a combination or a file cannot be.
  void take(const GivenOptions& given) {
    for (const auto& [name, words] : given) {
      OptionRow* const row = options.find(name);
      if (row == nullptr) throw InputError(name + ": is no option of " + name_);
      OptionTable::set(*row, std::vector<std::string>(words.begin(), words.end()));
    }
    options.check_combination();
    options.check_files();
  }
  // The summary as JSON, with the lines that the job said.
  std::string figures() {
    summary["remarks"] = remarks_;
    return summary.dump(-1, ' ', false, nlohmann::ordered_json::error_handler_t::replace);
  }

 private:
  JobState& state_;
  mutable std::vector<std::string> remarks_;
};

// Name, Python type, meaning and words of the value ("N in [1 - 100] (default 7)") of each option.
using OptionDescription = std::tuple<std::string, std::string, std::string, std::string>;
std::vector<OptionDescription> descriptions_of(const OptionTable& options);

}  // namespace astrolith::python
