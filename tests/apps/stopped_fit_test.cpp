// fit_shape after Ctrl-C: what it kept, what it says, and its status.
#include <fcntl.h>
#include <signal.h>

#include <chrono>
#include <thread>

#include "recipe/recipe_json.h"
#include "tests/apps/program_runner.h"
#include "tests/support/data.h"

namespace astrolith {
namespace {

using testing::Outcome;
using testing::text_of;
using testing::WorkFolder;

// Runs fit_shape in the folder and presses Ctrl-C after a while.
Outcome stopped_fit(const WorkFolder& folder, const std::string& mesh, std::chrono::milliseconds after) {
  const std::string errors = (folder / "errors").string();
  std::vector<std::string> words{ASTROLITH_FIT_SHAPE, mesh, "-o",           (folder / "fit.json").string(),
                                 "--spheres",         "60", "--checkpoint", (folder / "fit.cp").string()};
  std::vector<char*> argv;
  for (std::string& word : words) argv.push_back(word.data());
  argv.push_back(nullptr);
  posix_spawn_file_actions_t actions;
  posix_spawn_file_actions_init(&actions);
  posix_spawn_file_actions_addopen(&actions, 2, errors.c_str(), O_WRONLY | O_CREAT, 0600);
  pid_t child = 0;
  const int failed = ::posix_spawn(&child, argv[0], &actions, nullptr, argv.data(), environ);
  posix_spawn_file_actions_destroy(&actions);
  if (failed != 0) return {};
  std::this_thread::sleep_for(after);
  ::kill(child, SIGINT);
  int status = 0;
  ::waitpid(child, &status, 0);
  const Outcome outcome{WIFEXITED(status) ? WEXITSTATUS(status) : 128 + WTERMSIG(status), "",
                        text_of(errors)};
  std::filesystem::remove(errors);
  return outcome;
}

TEST(StoppedFit, SaysWhatItKeptAndHasItsOwnStatus) {
  const std::filesystem::path mesh = testing::shared_shape("eros_gaskell_49k.ply");
  ASTROLITH_SKIP_WITHOUT(mesh);
  for (const int milliseconds : {500, 2000, 4000, 8000}) {
    const WorkFolder folder;
    const Outcome outcome = stopped_fit(folder, mesh.string(), std::chrono::milliseconds(milliseconds));
    if (outcome.status == 128 + SIGINT) {  // before the program heeds signals, as where it starts slowly
      EXPECT_TRUE(folder.files().empty());
    } else if (outcome.status == 1) {  // before anything was fitted
      EXPECT_NE(outcome.errors.find("nothing was fitted yet"), std::string::npos) << outcome.errors;
      EXPECT_TRUE(folder.files().empty());
    } else {
      ASSERT_EQ(outcome.status, 3) << outcome.errors;
      EXPECT_NE(outcome.errors.find("fit.json holds the best so far"), std::string::npos) << outcome.errors;
      EXPECT_TRUE(read_recipe(folder / "fit.json").body.has_value());
      const bool with_checkpoint = folder.files().count("fit.cp") == 1;
      EXPECT_NE(outcome.errors.find(with_checkpoint ? "goes on from" : "no checkpoint yet"),
                std::string::npos)
          << outcome.errors;
    }
  }
}

}  // namespace
}  // namespace astrolith
