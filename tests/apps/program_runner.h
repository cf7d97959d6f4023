// Runs a built program as a user would, in a folder of its own.
#pragma once

#include <fcntl.h>
#include <spawn.h>
#include <sys/wait.h>

#include "tests/support/command_test.h"

namespace astrolith::testing {

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
inline int exit_status(pid_t child) {
  int status = 0;
  if (child < 0 || ::waitpid(child, &status, 0) != child) return -1;
  return WIFEXITED(status) ? WEXITSTATUS(status) : 128 + WTERMSIG(status);
}

inline Outcome run_program(const std::string& program, const std::vector<std::string>& arguments,
                           const std::filesystem::path& place = ".") {
  const ScratchFolder folder;
  const std::string output = folder / "output", errors = folder / "errors";
  const int status = exit_status(start_program(program, arguments, place, output, errors));
  return {status, read_text(output), read_text(errors)};
}

inline void expect_program_refusal(const ScratchFolder& folder, const std::string& program,
                                   const std::vector<std::string>& arguments, const std::string& culprit) {
  expect_refusal(folder, std::filesystem::path(program).filename(), culprit,
                 [&] { return run_program(program, arguments, folder.path()); });
}

// A test of one program, each run of which is a process.
class ProgramTest : public CommandTest {
 protected:
  explicit ProgramTest(const std::string& program)
      : CommandTest(std::filesystem::path(program).filename()), program_(program) {}

  Outcome run(const std::string& line) const override {
    return run_program(program_, split_words(line), folder_.path());
  }

 private:
  std::string program_;
};

}  // namespace astrolith::testing
