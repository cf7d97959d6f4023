// Programs after Ctrl-C: what they kept, what they say, and how they end.
#include <signal.h>

#include <chrono>
#include <thread>

#include "recipe/recipe_json.h"
#include "tests/apps/program_runner.h"
#include "tests/support/data.h"
#include "tests/tasks/inputs.h"

namespace astrolith {
namespace {

using testing::has;
using testing::ScratchFolder;

// Ctrl-C after the program has begun its longest work.
TEST(StoppedGravity, EndsWithinASecondAndLeavesNoFile) {
  const ScratchFolder folder;
  using Clock = std::chrono::steady_clock;
  folder.write("fine.obj", testing::ellipsoid_obj(3, 2, 1, 101, 200));
  folder.write("point.csv", "9 0 0\n");
  const std::set<std::string> before = folder.files();
  for (const std::string longest : {"--points point.csv --degree 50", "--exact"}) {
    const std::string line = "fine.obj --density 2000 --sample 0 --quiet -o fine.csv " + longest;
    const pid_t child = testing::start_program(ASTROLITH_GRAVITY, testing::split_words(line), folder.path());
    std::this_thread::sleep_for(std::chrono::milliseconds(1500));
    ASSERT_EQ(::waitpid(child, nullptr, WNOHANG), 0) << longest << " ended before it could be stopped";
    const auto pressed = Clock::now();
    ::kill(child, SIGINT);
    EXPECT_EQ(testing::exit_status(child), 128 + SIGINT) << longest;
    EXPECT_LT(std::chrono::duration<double>(Clock::now() - pressed).count(), 1.0) << longest;
    EXPECT_EQ(folder.files(), before) << longest;
  }
}

// Runs a fit that lasts longer than any wait of this test, and presses Ctrl-C after a while.
testing::Outcome stopped_fit(const ScratchFolder& folder, const std::string& mesh,
                             std::chrono::milliseconds after) {
  const ScratchFolder elsewhere;
  const std::string errors = elsewhere / "errors";
  const pid_t child = testing::start_program(
      ASTROLITH_FIT_SHAPE, {mesh, "-o", "fit.json", "--spheres", "300", "--checkpoint", "fit.cp"},
      folder.path(), "/dev/null", errors);
  std::this_thread::sleep_for(after);
  ::kill(child, SIGINT);
  const int status = testing::exit_status(child);
  return {status, "", testing::read_text(errors)};
}

TEST(StoppedFit, SaysWhatItKeptAndDiesOfTheSignalLong) {
  const std::filesystem::path mesh = testing::shared_shape("eros_gaskell_49k.ply");
  ASTROLITH_SKIP_WITHOUT(mesh);
  for (const int milliseconds : {500, 2000, 4000, 8000}) {
    const ScratchFolder folder;
    const testing::Outcome outcome =
        stopped_fit(folder, mesh.string(), std::chrono::milliseconds(milliseconds));
    EXPECT_EQ(outcome.status, 128 + SIGINT);
    if (folder.files().empty()) {  // before anything was fitted, or before the program heeds signals
      EXPECT_TRUE(outcome.errors.empty() || has(outcome.errors, "nothing was fitted yet"));
    } else {
      EXPECT_TRUE(has(outcome.errors, "fit.json holds the best so far"));
      EXPECT_TRUE(read_recipe(folder / "fit.json").body.has_value());
      const bool with_checkpoint = folder.files().count("fit.cp") == 1;
      EXPECT_TRUE(has(outcome.errors, with_checkpoint ? "goes on from" : "no checkpoint yet"));
    }
  }
}

}  // namespace
}  // namespace astrolith
