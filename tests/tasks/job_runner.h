// Runs a job in the test's own process, with the words of its program's command line.
#pragma once

#include <filesystem>
#include <functional>
#include <memory>
#include <string>
#include <vector>

#include "apps/program.h"
#include "tests/support/command_test.h"

namespace astrolith::testing {

using JobDeclaration = std::function<JobWork(Job&)>;

// The declaration of a job that stores its arguments elsewhere.
template <class Arguments, class Result>
JobDeclaration make_job(void (*declare)(Job&, Arguments&), Result (*work)(Job&, Arguments&)) {
  return [declare, work](Job& job) -> JobWork {
    const auto arguments = std::make_shared<Arguments>();
    declare(job, *arguments);
    return [&job, arguments, work] { work(job, *arguments); };
  };
}

// Runs the job in the folder `place`.
inline Outcome run_job(const std::string& name, const JobDeclaration& declare, std::vector<std::string> words,
                       const std::filesystem::path& place) {
  const std::filesystem::path before = std::filesystem::current_path();
  std::filesystem::current_path(place);
  Program program(name, "A job.");
  const JobWork work = declare(program);
  words.insert(words.begin(), name);
  std::vector<char*> argv;
  for (std::string& word : words) argv.push_back(word.data());
  ::testing::internal::CaptureStdout();
  ::testing::internal::CaptureStderr();
  const int status = program.run(static_cast<int>(argv.size()), argv.data(), work);
  std::filesystem::current_path(before);
  return {status, ::testing::internal::GetCapturedStdout(), ::testing::internal::GetCapturedStderr()};
}

// A test of one job, which has the name of its program.
class JobTest : public CommandTest {
 protected:
  JobTest(const std::string& name, JobDeclaration declare)
      : CommandTest(name), declare_(std::move(declare)) {}

  Outcome run(const std::string& line) const override {
    return run_job(name_, declare_, split_words(line), folder_.path());
  }

 private:
  JobDeclaration declare_;
};

}  // namespace astrolith::testing
