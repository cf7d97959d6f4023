// synth --page: the page of web/ with a recipe in it. A short file stands in for the page.
#include <cstdlib>

#include "recipe/base64.h"
#include "recipe/recipe_json.h"
#include "tests/tasks/synth/synth_runner.h"

namespace astrolith {
namespace {

const std::string kBefore = "<html><script type=\"application/json\" id=\"recipe\">";
const std::string kAfter = "</script></html>";

class SynthPage : public SynthTest {
 protected:
  SynthPage() { install(kBefore + "null" + kAfter); }
  ~SynthPage() override { unsetenv("ASTROLITH_PAGE"); }

  void install(const std::string& page) {
    write("page.html", page);
    setenv("ASTROLITH_PAGE", (folder_ / "page.html").c_str(), 1);
  }

  // What the element of the recipe holds.
  nlohmann::json held(const std::string& page) const {
    const std::string all = text(page);
    EXPECT_EQ(all.substr(0, kBefore.size()), kBefore);
    EXPECT_EQ(all.substr(all.size() - kAfter.size()), kAfter);
    return nlohmann::json::parse(all.substr(kBefore.size(), all.size() - kBefore.size() - kAfter.size()));
  }
};

TEST_F(SynthPage, HoldsTheRecipeThatWasMade) {
  succeed("r.json --seed 7 --page out");
  const nlohmann::json recipe = held("out/index.html");
  EXPECT_EQ(recipe["name"], "r.astro");
  const Recipe read = parse_recipe(base64_bytes(recipe["bytes"].get<std::string>()).value(), "page");
  EXPECT_EQ(read.seed, 7u);
}

TEST_F(SynthPage, IsWrittenBesideAMesh) {
  succeed("r.json --resolution 16 -o a.ply --page out");
  EXPECT_FALSE(text("a.ply").empty());
  EXPECT_FALSE(text("out/index.html").empty());
}

TEST_F(SynthPage, IsRefusedWhereItIsMissingOrAnotherFile) {
  install("<html></html>");
  refuse("r.json --page out", "page.html is missing or is not the page");
  setenv("ASTROLITH_PAGE", (folder_ / "absent.html").c_str(), 1);
  refuse("r.json --page out -o a.ply", "absent.html is missing");
  EXPECT_FALSE(std::filesystem::exists(folder_ / "a.ply"));
}

}  // namespace
}  // namespace astrolith
