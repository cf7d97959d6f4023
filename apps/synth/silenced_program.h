// Work of synth that is a part of other work, which alone speaks and has the summary.
#pragma once

#include <utility>

#include "apps/program.h"

namespace astrolith {

// While it lives, the program says nothing and writes another summary.
class SilencedProgram {
 public:
  explicit SilencedProgram(Program& program)
      : program_(program),
        quiet_(std::exchange(program.quiet, true)),
        summary_(std::exchange(program.summary, {})) {}
  SilencedProgram(const SilencedProgram&) = delete;
  SilencedProgram& operator=(const SilencedProgram&) = delete;
  ~SilencedProgram() {
    program_.quiet = quiet_;
    program_.summary = std::move(summary_);
  }

 private:
  Program& program_;
  bool quiet_;
  nlohmann::ordered_json summary_;
};

}  // namespace astrolith
