// The answers that all programs give alike: help, version, refusals.
#include <regex>

#include "tests/apps/program_runner.h"

namespace astrolith {
namespace {

using testing::Outcome;
using testing::run_program;

class EveryProgram : public ::testing::TestWithParam<const char*> {
 protected:
  std::string name() const { return std::filesystem::path(GetParam()).filename(); }
};

TEST_P(EveryProgram, HelpStatesTheOptions) {
  const Outcome outcome = run_program(GetParam(), {"--help"});
  EXPECT_EQ(outcome.status, 0);
  EXPECT_EQ(outcome.errors, "");
  for (const char* option : {"--seed", "--threads", "--quiet", "--summary", "--version", "--output"}) {
    EXPECT_NE(outcome.output.find(option), std::string::npos) << option;
  }
}

TEST_P(EveryProgram, VersionIsOneLine) {
  const Outcome outcome = run_program(GetParam(), {"--version"});
  EXPECT_EQ(outcome.status, 0);
  // "synth 0.2.0 (1a2b3c4, modified)"; only the release where the build knew of no commit.
  const std::regex line(name() + R"( \d+\.\d+\.\d+( \([0-9a-f]{7,}(, modified)?\))?\n)");
  EXPECT_TRUE(std::regex_match(outcome.output, line)) << outcome.output;
}

TEST_P(EveryProgram, WrongCommandLinesAreRefused) {
  const testing::WorkFolder folder;
  const std::string output = (folder / "out").string();
  testing::expect_refusal(folder, GetParam(), {}, "required");
  const auto refuse = [&](std::vector<std::string> more, const std::string& culprit) {
    std::vector<std::string> arguments{"in", "-o", output};
    if (name() == "compare") arguments.push_back("other_in");
    arguments.insert(arguments.end(), more.begin(), more.end());
    testing::expect_refusal(folder, GetParam(), arguments, culprit);
  };
  refuse({"--no-such-option"}, "--no-such-option");
  refuse({"--threads", "many"}, "--threads");
  refuse({"--seed", "-1"}, "--seed");
}

std::string file_name(const ::testing::TestParamInfo<const char*>& program) {
  return std::filesystem::path(program.param).filename();
}

INSTANTIATE_TEST_SUITE_P(Programs, EveryProgram, ::testing::Values(ASTROLITH_PROGRAMS), file_name);

}  // namespace
}  // namespace astrolith
