#include "numerics/files/append_line.h"

#include <gtest/gtest.h>
#include <sys/wait.h>
#include <unistd.h>

#include <fstream>
#include <string>

#include "numerics/errors.h"
#include "tests/support/scratch_folder.h"

namespace astrolith {
namespace {

using testing::text_of;

TEST(AppendLine, MakesAndExtendsTheFile) {
  const testing::ScratchFolder folder;
  append_line(folder / "m.jsonl", "one");
  append_line(folder / "m.jsonl", "two");
  EXPECT_EQ(text_of(folder / "m.jsonl"), "one\ntwo\n");
}

TEST(AppendLine, LeavesALineThatWasCutShortAlone) {
  const testing::ScratchFolder folder;
  std::ofstream(folder / "m.jsonl") << "one\n{\"mem";
  append_line(folder / "m.jsonl", "two");
  EXPECT_EQ(text_of(folder / "m.jsonl"), "one\n{\"mem\ntwo\n");
}

TEST(AppendLine, KeepsTheLinesOfTwoProcessesWhole) {
  const testing::ScratchFolder folder;
  const std::string line(3000, 'x');
  const pid_t child = ::fork();
  for (int i = 0; i < 200; ++i) append_line(folder / "m.jsonl", line);
  if (child == 0) ::_exit(0);
  ::waitpid(child, nullptr, 0);
  std::ifstream file(folder / "m.jsonl");
  int lines = 0;
  for (std::string read; std::getline(file, read); ++lines) EXPECT_EQ(read, line);
  EXPECT_EQ(lines, 400);
}

TEST(AppendLine, RefusesAFolder) {
  const testing::ScratchFolder folder;
  EXPECT_THROW(append_line(folder / ".", "x"), InputError);
  EXPECT_THROW(append_line(folder / "absent" / "m.jsonl", "x"), InputError);
}

}  // namespace
}  // namespace astrolith
