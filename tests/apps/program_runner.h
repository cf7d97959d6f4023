// Runs a built program as a user would, in a folder of its own, and checks its messages and its files.
#pragma once

#include <fcntl.h>
#include <gtest/gtest.h>
#include <spawn.h>
#include <sys/wait.h>

#include <algorithm>
#include <iomanip>
#include <nlohmann/json.hpp>
#include <sstream>
#include <utility>
#include <vector>

#include "tests/support/refusal.h"
#include "tests/support/scratch_folder.h"

namespace astrolith::testing {

using WorkFolder = ScratchFolder;

struct Outcome {
  int status = -1;  // exit status, or 128 + the signal that ended the program
  std::string output, errors;
};

// Starts the program in the folder `place`. Returns -1 where that fails.
inline pid_t start_program(const std::string& program, std::vector<std::string> arguments,
                           const std::filesystem::path& place, const std::string& output = "/dev/null",
                           const std::string& errors = "/dev/null") {
  posix_spawn_file_actions_t actions;
  posix_spawn_file_actions_init(&actions);
  posix_spawn_file_actions_addopen(&actions, 0, "/dev/null", O_RDONLY, 0);
  posix_spawn_file_actions_addopen(&actions, 1, output.c_str(), O_WRONLY | O_CREAT, 0600);
  posix_spawn_file_actions_addopen(&actions, 2, errors.c_str(), O_WRONLY | O_CREAT, 0600);
  posix_spawn_file_actions_addchdir_np(&actions, place.c_str());
  arguments.insert(arguments.begin(), program);
  std::vector<char*> argv;
  for (std::string& argument : arguments) argv.push_back(argument.data());
  argv.push_back(nullptr);
  pid_t child = 0;
  const int failed = ::posix_spawn(&child, program.c_str(), &actions, nullptr, argv.data(), environ);
  posix_spawn_file_actions_destroy(&actions);
  return failed == 0 ? child : -1;
}

// Waits for the program's end and returns its status as in Outcome.
inline int status_of(pid_t child) {
  int status = 0;
  if (child < 0 || ::waitpid(child, &status, 0) != child) return -1;
  return WIFEXITED(status) ? WEXITSTATUS(status) : 128 + WTERMSIG(status);
}

inline Outcome run_program(const std::string& program, const std::vector<std::string>& arguments,
                           const std::filesystem::path& place = ".") {
  const ScratchFolder folder;
  const std::string output = folder / "output", errors = folder / "errors";
  const int status = status_of(start_program(program, arguments, place, output, errors));
  return {status, text_of(output), text_of(errors)};
}

// The words of a command line, which spaces separate; "" is an empty word.
inline std::vector<std::string> words_of(const std::string& line) {
  std::vector<std::string> words;
  std::istringstream text(line);
  for (std::string word; text >> std::quoted(word);) words.push_back(word);
  return words;
}

// Checks the promise about bad input: status 2, one line that names `culprit` and a remedy, and no file left
// behind.
inline void expect_refusal(const ScratchFolder& folder, const std::string& program,
                           const std::vector<std::string>& arguments, const std::string& culprit) {
  const std::set<std::string> before = folder.files();
  const Outcome outcome = run_program(program, arguments, folder.path());
  const std::string name = std::filesystem::path(program).filename();
  EXPECT_EQ(outcome.status, 2) << outcome.errors;
  EXPECT_EQ(outcome.errors.rfind(name + ": ", 0), 0u) << outcome.errors;
  EXPECT_EQ(std::count(outcome.errors.begin(), outcome.errors.end(), '\n'), 1) << outcome.errors;
  EXPECT_TRUE(has(outcome.errors, culprit));
  EXPECT_TRUE(has(outcome.errors, "; ") || has(outcome.errors, ": must be ")) << outcome.errors;
  EXPECT_EQ(outcome.output, "");
  EXPECT_EQ(folder.files(), before);
}

// A test of one program. Names of files are those of the test's own folder, where the program runs.
class ProgramTest : public ::testing::Test {
 protected:
  explicit ProgramTest(std::string program) : program_(std::move(program)) {}

  // Returns the name, to be put into a command line.
  std::string write(const std::string& name, std::string_view content) const {
    folder_.write(name, content);
    return name;
  }
  std::string text(const std::string& name) const { return text_of(folder_ / name); }
  nlohmann::json json(const std::string& name) const { return nlohmann::json::parse(text(name)); }
  bool exists(const std::string& name) const { return std::filesystem::exists(folder_ / name); }

  Outcome run(const std::string& line) const { return run_program(program_, words_of(line), folder_.path()); }
  // Expects that the program succeeds, and returns what it says.
  std::string succeed(const std::string& line) const {
    const Outcome outcome = run(line);
    EXPECT_EQ(outcome.status, 0) << line << "\n" << outcome.errors;
    return outcome.errors;
  }
  void refuse(const std::string& line, const std::string& culprit) const {
    SCOPED_TRACE(line);
    expect_refusal(folder_, program_, words_of(line), culprit);
  }

  ScratchFolder folder_;

 private:
  std::string program_;
};

}  // namespace astrolith::testing
