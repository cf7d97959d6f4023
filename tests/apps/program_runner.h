// Runs a built program as a user would, in a folder of its own, and checks its messages and its files.
#pragma once

#include <fcntl.h>
#include <gtest/gtest.h>
#include <spawn.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <filesystem>
#include <fstream>
#include <set>
#include <sstream>
#include <string>
#include <vector>

namespace astrolith::testing {

struct Outcome {
  int status = -1;  // exit status, or 128 + the signal that ended the program
  std::string output, errors;
};

inline std::string text_of(const std::filesystem::path& file) {
  std::ostringstream text;
  text << std::ifstream(file, std::ios::binary).rdbuf();
  return text.str();
}

// A temporary folder that goes away with its owner.
class WorkFolder {
 public:
  WorkFolder() {
    std::string name = (std::filesystem::temp_directory_path() / "astrolith_apps_XXXXXX").string();
    if (::mkdtemp(name.data()) == nullptr) throw std::runtime_error("no temporary folder");
    path_ = name;
  }
  WorkFolder(const WorkFolder&) = delete;
  WorkFolder& operator=(const WorkFolder&) = delete;
  ~WorkFolder() { std::filesystem::remove_all(path_); }

  std::filesystem::path operator/(const std::string& name) const { return path_ / name; }
  std::string write(const std::string& name, const std::string& content) const {
    std::ofstream(path_ / name, std::ios::binary) << content;
    return (path_ / name).string();
  }
  std::set<std::string> files() const {
    std::set<std::string> names;
    for (const auto& entry : std::filesystem::directory_iterator(path_))
      names.insert(entry.path().filename());
    return names;
  }

 private:
  std::filesystem::path path_;
};

inline Outcome run_program(const std::string& program, std::vector<std::string> arguments) {
  const WorkFolder folder;
  const std::string output = (folder / "output").string(), errors = (folder / "errors").string();
  posix_spawn_file_actions_t actions;
  posix_spawn_file_actions_init(&actions);
  posix_spawn_file_actions_addopen(&actions, 0, "/dev/null", O_RDONLY, 0);
  posix_spawn_file_actions_addopen(&actions, 1, output.c_str(), O_WRONLY | O_CREAT, 0600);
  posix_spawn_file_actions_addopen(&actions, 2, errors.c_str(), O_WRONLY | O_CREAT, 0600);
  arguments.insert(arguments.begin(), program);
  std::vector<char*> argv;
  for (std::string& argument : arguments) argv.push_back(argument.data());
  argv.push_back(nullptr);
  pid_t child = 0;
  const int failed = ::posix_spawn(&child, program.c_str(), &actions, nullptr, argv.data(), environ);
  posix_spawn_file_actions_destroy(&actions);
  int status = 0;
  if (failed != 0 || ::waitpid(child, &status, 0) != child) return {};
  return {WIFEXITED(status) ? WEXITSTATUS(status) : 128 + WTERMSIG(status), text_of(output), text_of(errors)};
}

// Checks the promise about bad input: status 2, one line that names `culprit` and a remedy, and no file left
// behind.
inline void expect_refusal(const WorkFolder& folder, const std::string& program,
                           const std::vector<std::string>& arguments, const std::string& culprit) {
  const std::set<std::string> before = folder.files();
  const Outcome outcome = run_program(program, arguments);
  const std::string name = std::filesystem::path(program).filename();
  EXPECT_EQ(outcome.status, 2) << outcome.errors;
  EXPECT_EQ(outcome.errors.rfind(name + ": ", 0), 0u) << outcome.errors;
  EXPECT_EQ(std::count(outcome.errors.begin(), outcome.errors.end(), '\n'), 1) << outcome.errors;
  EXPECT_NE(outcome.errors.find(culprit), std::string::npos) << culprit << " is not in: " << outcome.errors;
  const bool says_what_to_do = outcome.errors.find("; ") != std::string::npos ||
                               outcome.errors.find(": must be ") != std::string::npos;
  EXPECT_TRUE(says_what_to_do) << outcome.errors;
  EXPECT_EQ(outcome.output, "");
  EXPECT_EQ(folder.files(), before);
}

}  // namespace astrolith::testing
