// Programs that are killed at any moment leave whole files only.
#include <fcntl.h>
#include <signal.h>

#include <chrono>
#include <map>
#include <thread>

#include "tests/apps/program_runner.h"

namespace astrolith {
namespace {

using testing::text_of;
using testing::WorkFolder;
using Clock = std::chrono::steady_clock;

const std::string kBody = R"({"format_version": 1, "length_unit": "km",
  "body": {"type": "metaballs", "spheres": [[0, 0, 0, 1], [1, 0, 0, 0.75]]},
  "layers": [{"type": "simplex", "amplitude": 0.05, "frequency": 2, "octaves": 4}]})";

pid_t start_synth(const std::string& recipe, const WorkFolder& folder) {
  const std::vector<std::string> words{ASTROLITH_SYNTH,
                                       recipe,
                                       "-o",
                                       (folder / "mesh.ply").string(),
                                       "--preview",
                                       (folder / "picture.png").string(),
                                       "--resolution",
                                       "64",
                                       "--quiet"};
  std::vector<char*> argv;
  for (const std::string& word : words) argv.push_back(const_cast<char*>(word.c_str()));
  argv.push_back(nullptr);
  pid_t child = 0;
  return ::posix_spawn(&child, argv[0], nullptr, nullptr, argv.data(), environ) == 0 ? child : -1;
}

void wait_for(pid_t child) {
  int status = 0;
  ASSERT_EQ(::waitpid(child, &status, 0), child);
}

std::map<std::string, std::string> content_of(const WorkFolder& folder) {
  std::map<std::string, std::string> content;
  for (const std::string& name : folder.files()) content[name] = text_of(folder / name);
  return content;
}

TEST(KilledProgram, LeavesWholeFilesOnly) {
  const WorkFolder place;
  const std::string recipe = place.write("r.json", kBody);
  if (const int file = ::open((place / "").c_str(), O_TMPFILE | O_WRONLY, 0600); file >= 0) {
    ::close(file);
  } else {
    GTEST_SKIP() << "no nameless files in " << place / "";
  }
  const WorkFolder whole;
  const auto start = Clock::now();
  wait_for(start_synth(recipe, whole));
  const auto time = Clock::now() - start;
  const std::map<std::string, std::string> wanted = content_of(whole);
  ASSERT_EQ(wanted.size(), 2u);

  constexpr int kMoments = 30;
  for (int moment = 1; moment <= kMoments; ++moment) {
    const WorkFolder folder;
    const pid_t child = start_synth(recipe, folder);
    std::this_thread::sleep_for(time * moment / kMoments);
    ::kill(child, SIGKILL);
    wait_for(child);
    for (const auto& [name, content] : content_of(folder)) {
      ASSERT_EQ(wanted.count(name), 1u) << name << " was left at moment " << moment;
      EXPECT_EQ(content, wanted.at(name)) << name << " is not whole at moment " << moment;
    }
  }
}

}  // namespace
}  // namespace astrolith
