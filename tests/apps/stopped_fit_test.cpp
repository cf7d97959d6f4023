// fit_shape after Ctrl-C: what it kept, what it says, and its status.
#include <signal.h>

#include <chrono>
#include <thread>

#include "recipe/recipe_json.h"
#include "tests/apps/program_runner.h"
#include "tests/support/data.h"

namespace astrolith {
namespace {

using testing::has;
using testing::ScratchFolder;

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
  const int status = testing::status_of(child);
  return {status, "", testing::text_of(errors)};
}

TEST(StoppedFit, SaysWhatItKeptAndHasItsOwnStatusLong) {
  const std::filesystem::path mesh = testing::shared_shape("eros_gaskell_49k.ply");
  ASTROLITH_SKIP_WITHOUT(mesh);
  for (const int milliseconds : {500, 2000, 4000, 8000}) {
    const ScratchFolder folder;
    const testing::Outcome outcome =
        stopped_fit(folder, mesh.string(), std::chrono::milliseconds(milliseconds));
    if (outcome.status == 128 + SIGINT) {  // before the program heeds signals, as where it starts slowly
      EXPECT_TRUE(folder.files().empty());
    } else if (outcome.status == 1) {  // before anything was fitted
      EXPECT_TRUE(has(outcome.errors, "nothing was fitted yet"));
      EXPECT_TRUE(folder.files().empty());
    } else {
      ASSERT_EQ(outcome.status, 3) << outcome.errors;
      EXPECT_TRUE(has(outcome.errors, "fit.json holds the best so far"));
      EXPECT_TRUE(read_recipe(folder / "fit.json").body.has_value());
      const bool with_checkpoint = folder.files().count("fit.cp") == 1;
      EXPECT_TRUE(has(outcome.errors, with_checkpoint ? "goes on from" : "no checkpoint yet"));
    }
  }
}

}  // namespace
}  // namespace astrolith
