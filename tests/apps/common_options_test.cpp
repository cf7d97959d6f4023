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

// help2man makes man pages from this layout: two spaces or a new line before each description.
TEST_P(EveryProgram, HelpCanBecomeAManPage) {
  std::istringstream help(run_program(GetParam(), {"--help"}).output);
  const std::regex names(R"(  (-\w, )?--[a-z-]+( .*)?)"), description(R"( {30}.*)");
  std::size_t options = 0;
  for (std::string line; std::getline(help, line);) {
    if (line.rfind("  -", 0) != 0) continue;
    ++options;
    EXPECT_TRUE(std::regex_match(line, names)) << line;
    const std::size_t gap = line.find("  ", 3);
    EXPECT_EQ(line.find("[]"), std::string::npos) << line;
    // A description on the same line begins behind two spaces at least.
    if (gap != std::string::npos) {
      EXPECT_GE(line.find_first_not_of(' ', gap), 30u) << line;
    } else {
      std::string next;
      ASSERT_TRUE(std::getline(help, next));
      EXPECT_TRUE(std::regex_match(next, description)) << line << "\n" << next;
    }
  }
  EXPECT_GE(options, 6u);
}

TEST_P(EveryProgram, VersionIsOneLine) {
  const Outcome outcome = run_program(GetParam(), {"--version"});
  EXPECT_EQ(outcome.status, 0);
  // "synth 0.2.0 (1a2b3c4, modified)"; only the release where the build knew of no commit.
  const std::regex line(name() + R"( \d+\.\d+\.\d+( \([0-9a-f]{7,}(, modified)?\))?\n)");
  EXPECT_TRUE(std::regex_match(outcome.output, line)) << outcome.output;
}

TEST_P(EveryProgram, WrongCommandLinesAreRefused) {
  const testing::ScratchFolder folder;
  const std::string output = (folder / "out").string();
  testing::expect_program_refusal(folder, GetParam(), {}, "required");
  const auto refuse = [&](std::vector<std::string> more, const std::string& culprit) {
    std::vector<std::string> arguments{"in", "-o", output};
    if (name() == "compare") arguments.push_back("other_in");
    arguments.insert(arguments.end(), more.begin(), more.end());
    testing::expect_program_refusal(folder, GetParam(), arguments, culprit);
  };
  refuse({"--no-such-option"}, "--no-such-option");
  refuse({"--threads", "many"}, "--threads");
  refuse({"--seed", "-1"}, "--seed");
}

TEST_P(EveryProgram, OutputsWithAWrongEndingAreRefusedBeforeAnyWork) {
  const testing::ScratchFolder folder;
  std::vector<std::string> arguments{"in", "-o", (folder / "out.docx").string()};
  if (name() == "compare") arguments.push_back("other_in");
  if (name() == "gravity") arguments.insert(arguments.end(), {"--density", "2000"});
  testing::expect_program_refusal(folder, GetParam(), arguments, "out.docx: ");
}

std::string file_name(const ::testing::TestParamInfo<const char*>& program) {
  return std::filesystem::path(program.param).filename();
}

INSTANTIATE_TEST_SUITE_P(Programs, EveryProgram, ::testing::Values(ASTROLITH_PROGRAMS), file_name);

}  // namespace
}  // namespace astrolith
