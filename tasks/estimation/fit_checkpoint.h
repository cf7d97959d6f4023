// The checkpoint of fit_shape: a JSON file with the finished base and the value of every candidate for the
// details so far. The search is a function of these values (estimation/optimize/evaluation_log.h), so a
// resumed run ends like a run without a stop.
#pragma once

#include <filesystem>
#include <string>
#include <utility>
#include <vector>

#include "estimation/optimize/evaluation_log.h"
#include "estimation/shape/fit/shape_fit.h"

namespace astrolith {

// The run that a checkpoint belongs to. A checkpoint of another input, of other options or of other code is
// refused.
struct CheckpointKey {
  std::string tool;     // name, version and commit of the program
  std::string changes;  // CodeVersion::changes
  std::string input_sha256;
  std::vector<std::pair<std::string, std::string>> options;
};

class FitCheckpoint {
 public:
  // Reads the file where it exists. Throws InputError for a file that is damaged or belongs to another run.
  // With an empty name nothing is ever read or written.
  FitCheckpoint(std::filesystem::path file, CheckpointKey key);

  bool resumed() const { return resumed_; }
  // A finished base from the file; body, history and figures are set, the check is not.
  bool has_base() const { return has_base_; }
  const ShapeFitResult* base() const { return has_base_ ? &base_ : nullptr; }
  EvaluationLog& log() { return log_; }

  // Writes the file at once.
  void keep_base(const ShapeFitResult& base);
  // Passes on to `progress`; writes the file when enough is new, and when the work is asked to stop.
  Progress guard(Progress progress);
  void save();

 private:
  void read();

  std::filesystem::path file_;
  CheckpointKey key_;
  bool resumed_ = false, has_base_ = false;
  ShapeFitResult base_;
  EvaluationLog log_;
  std::size_t saved_evaluations_ = 0;
};

}  // namespace astrolith
