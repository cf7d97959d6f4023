// Checks what command lines make and say, whether a program or a job in the test's own process runs them.
#pragma once

#include <gtest/gtest.h>

#include <algorithm>
#include <filesystem>
#include <iomanip>
#include <nlohmann/json.hpp>
#include <set>
#include <sstream>
#include <string>
#include <utility>
#include <vector>

#include "tests/support/refusal.h"
#include "tests/support/scratch_folder.h"

namespace astrolith::testing {

struct Outcome {
  int status = -1;  // exit status, or 128 + the signal that ended the program
  std::string output, errors;
};

// The words of a command line, which spaces separate; "" is an empty word.
inline std::vector<std::string> split_words(const std::string& line) {
  std::vector<std::string> words;
  std::istringstream text(line);
  for (std::string word; text >> std::quoted(word);) words.push_back(word);
  return words;
}

// Checks the promise about bad input: status 2, one line that names `culprit` and a remedy, and no file left
// behind. `run` runs a program of this name in the folder.
template <typename Run>
void expect_refusal(const ScratchFolder& folder, const std::string& name, const std::string& culprit,
                    const Run& run) {
  const std::set<std::string> before = folder.files();
  const Outcome outcome = run();
  EXPECT_EQ(outcome.status, 2) << outcome.errors;
  EXPECT_EQ(outcome.errors.rfind(name + ": ", 0), 0u) << outcome.errors;
  EXPECT_EQ(std::count(outcome.errors.begin(), outcome.errors.end(), '\n'), 1) << outcome.errors;
  EXPECT_TRUE(has(outcome.errors, culprit));
  EXPECT_TRUE(has(outcome.errors, "; ") || has(outcome.errors, ": must be ")) << outcome.errors;
  EXPECT_EQ(outcome.output, "");
  EXPECT_EQ(folder.files(), before);
}

// Command lines, each with the culprit that the refusal names.
using Refusals = std::vector<std::pair<std::string, std::string>>;

// A test of one program or job. Names of files are those of the test's own folder, where it runs.
class CommandTest : public ::testing::Test {
 protected:
  explicit CommandTest(std::string name) : name_(std::move(name)) {}

  virtual Outcome run(const std::string& line) const = 0;

  // Returns the name, to be put into a command line.
  std::string write(const std::string& name, std::string_view content) const {
    folder_.write(name, content);
    return name;
  }
  std::string text(const std::string& name) const { return read_text(folder_ / name); }
  nlohmann::json json(const std::string& name) const { return nlohmann::json::parse(text(name)); }
  bool exists(const std::string& name) const { return std::filesystem::exists(folder_ / name); }

  // Expects that the command succeeds, and returns what it says.
  std::string succeed(const std::string& line) const {
    const Outcome outcome = run(line);
    EXPECT_EQ(outcome.status, 0) << line << "\n" << outcome.errors;
    return outcome.errors;
  }
  // The summary of a command that succeeds.
  nlohmann::json figures(const std::string& line) const {
    succeed(line + " --summary s.json");
    return json("s.json");
  }
  void refuse(const std::string& line, const std::string& culprit) const {
    SCOPED_TRACE(line);
    expect_refusal(folder_, name_, culprit, [&] { return run(line); });
  }
  // Refuses all lines, each behind the same beginning.
  void refuse_all(const std::string& beginning, const Refusals& refusals) const {
    for (const auto& [words, culprit] : refusals) refuse(beginning + words, culprit);
  }

  ScratchFolder folder_;
  std::string name_;
};

}  // namespace astrolith::testing
