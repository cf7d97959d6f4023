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

// Python hands over the text of a recipe. The page is sought in the caller's prefixes.
TEST_F(SynthPage, OfACallersRecipeHasItsNameAndLiesInAPrefix) {
  unsetenv("ASTROLITH_PAGE");
  std::filesystem::create_directories(folder_ / "second/share/astrolith");
  write("second/share/astrolith/page.html", kBefore + "null" + kAfter);
  const auto called = [&](std::vector<std::filesystem::path> prefixes, const std::string& page) {
    const auto declare = [&](Job& job) {
      return declare_called_synth(job, {text("r.json"), std::move(prefixes)});
    };
    return testing::run_job("synth", declare, {"--page", page}, folder_.path());
  };
  const testing::Outcome found = called({folder_ / "first", folder_ / "second"}, "out");
  EXPECT_EQ(found.status, 0) << found.errors;
  EXPECT_EQ(held("out/index.html")["name"], "recipe.astro");
  const testing::Outcome none = called({folder_ / "first", folder_ / "third"}, "other");
  EXPECT_EQ(none.status, 2);
  EXPECT_TRUE(testing::has(none.errors, "first/share/astrolith/page.html is missing")) << none.errors;
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
