// The library of measured bodies: its recipes, and how a word finds them.
#include <cstdlib>
#include <fstream>

#include "geometry/io/mesh_io.h"
#include "geometry/mesh_measure.h"
#include "recipe/recipe_json.h"
#include "tasks/gravity/gravity_job.h"
#include "tasks/job/body_library.h"
#include "tests/tasks/synth/synth_runner.h"

namespace astrolith {
namespace {

// The test's own program lies in the folder of the build, where the programs' library is found.
class SynthLibrary : public SynthTest {
 protected:
  ~SynthLibrary() override { unsetenv("ASTROLITH_LIBRARY"); }

  nlohmann::json summary(const std::string& line) const {
    succeed(line + " --summary s.json");
    return nlohmann::json::parse(text("s.json"));
  }
};

// The rows of library/bodies.json.
std::vector<nlohmann::json> table() {
  std::ifstream stream(find_body("eros").parent_path() / "bodies.json");
  return nlohmann::json::parse(stream).at("bodies");
}

TEST_F(SynthLibrary, AWordThatIsNoFileIsABody) {
  EXPECT_TRUE(summary("eros --resolution 32 -o e.ply")["closed"].get<bool>());
  const std::string mesh = text("e.ply");
  succeed("Eros --resolution 32 -o capital.ply");
  EXPECT_EQ(text("capital.ply"), mesh);
  std::filesystem::create_directory(folder_ / "eros");  // an artist's folder hides no body
  succeed("eros --resolution 32 -o eros/again.ply");
  EXPECT_EQ(text("eros/again.ply"), mesh);
}

// The population of all bodies draws others, with the ground of the one that is most like them.
TEST_F(SynthLibrary, HasAPopulation) {
  const nlohmann::json bare =
      summary("asteroids --diameter 330 --class elongated --details none --resolution 32 -o b.ply");
  EXPECT_EQ(bare["drawn_body"]["class"], "elongated");
  EXPECT_EQ(bare["drawn_body"]["diameter"], 330.0);
  EXPECT_EQ(bare["components"], 1);
}

TEST_F(SynthLibrary, LaysGroundOnDrawnBodiesLong) {
  const nlohmann::json made = summary(
      "asteroids --diameter 330 --class contact_binary --seed 3 --details all --resolution 48 -o g.ply "
      "--write-recipe g.astro");
  EXPECT_EQ(made["drawn_body"]["ground"], "itokawa");
  EXPECT_TRUE(made["closed"].get<bool>());
  succeed("g.astro -o again.ply --resolution 48");
  EXPECT_EQ(text("again.ply"), text("g.ply"));
  succeed("asteroids --diameter 330 --seed 3 --like --write-recipe like.json");
  EXPECT_NE(text("like.json").find("\"arrangement\": \"like\""), std::string::npos);
}

TEST_F(SynthLibrary, HeightsOfItsOwnGiveTheSameMesh) {
  succeed("ky26 --laid --seed 4 --own-heights --write-recipe own.astro -o laid.ply --resolution 40");
  succeed("own.astro -o own.ply --resolution 40");
  EXPECT_EQ(text("own.ply"), text("laid.ply"));
  refuse("ky26 --own-heights --write-recipe own.astro",
         "ky26: layers: no relief draws its heights; add --like, --laid or --fill-unseen");
}

TEST_F(SynthLibrary, AFileComesBeforeABody) {
  write("eros", kTwoSpheres);
  EXPECT_EQ(synthesise("a.ply"), (succeed("eros -o b.ply --resolution 32"), text("b.ply")));
}

TEST_F(SynthLibrary, GivesABaseAndABodyOfGravity) {
  EXPECT_GT(summary("r.json --base bennu --resolution 32 -o b.ply")["triangles"].get<int>(), 100);
  const testing::Outcome made =
      testing::run_job("gravity", declare_gravity,
                       {"bennu", "--density", "1190", "--resolution", "24", "--json"}, folder_.path());
  EXPECT_EQ(made.status, 0) << made.errors;
  EXPECT_EQ(nlohmann::json::parse(made.output)["shape"], "bennu");
}

TEST_F(SynthLibrary, AnUnknownWordNamesTheNearestBodyOrAll) {
  refuse("erso -o e.ply", "erso: is no file and no body of the library; did you mean eros?");
  refuse("xyzzy -o e.ply", "xyzzy: is no file and no body of the library; it has amalthea, apophis,");
  refuse("erso.astro -o e.ply", "erso.astro: cannot be read (No such file or directory)");
  refuse("./eros -o e.ply", "./eros: cannot be read (No such file or directory)");
}

TEST_F(SynthLibrary, LiesInAFolderThatTheEnvironmentNames) {
  write_recipe(parse_recipe(kTwoSpheres, "r"), folder_ / "two.astro");
  setenv("ASTROLITH_LIBRARY", folder_.path().c_str(), 1);
  EXPECT_EQ(library_bodies(), std::vector<std::string>{"two"});
  succeed("two -o two.ply --resolution 32");
  refuse("eros -o e.ply", "it has two");
  setenv("ASTROLITH_LIBRARY", (folder_ / "none").c_str(), 1);
  refuse("eros -o e.ply", "eros: cannot be read (No such file or directory)");
}

TEST_F(SynthLibrary, ABodyIsNoOutput) {
  std::filesystem::copy_file(find_body("ky26"), folder_ / "ky26.astro");
  setenv("ASTROLITH_LIBRARY", folder_.path().c_str(), 1);
  refuse("ky26 --write-recipe ky26.astro", "ky26.astro");
}

TEST_F(SynthLibrary, TableAndRecipesAgree) {
  std::vector<std::string> names;
  for (const nlohmann::json& body : table()) {
    const std::string name = body.at("name");
    names.push_back(name);
    const Recipe recipe = read_recipe(find_body(name));
    EXPECT_EQ(recipe.length_unit, "km") << name;
    for (const char* const stated : {"title", "credit", "licence"}) {
      EXPECT_NE(recipe.description.find(body.at(stated).get<std::string>()), std::string::npos) << name;
    }
  }
  EXPECT_EQ(library_bodies(), names);
}

// The lobes of Arrokoth overlap, so that it, too, is one part.
TEST_F(SynthLibrary, EachBodyIsClosedOfOnePartAndHasTheVolumeOfItsModelLong) {
  for (const nlohmann::json& body : table()) {
    const std::string name = body.at("name");
    const nlohmann::json made = summary(name + " --resolution 128 -o b.ply");
    EXPECT_TRUE(made["closed"].get<bool>() && made["manifold"].get<bool>()) << name;
    EXPECT_EQ(made["components"], 1) << name;
    EXPECT_NEAR(volume(read_mesh(folder_ / "b.ply")) / body.at("volume_km3").get<double>(), 1.0, 0.005)
        << name;
  }
}

}  // namespace
}  // namespace astrolith
