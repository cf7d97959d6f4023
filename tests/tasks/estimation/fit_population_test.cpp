// fit_population, and the bodies that synth draws from its populations.
#include "tasks/estimation/fit_population.h"

#include "geometry/io/mesh_io.h"
#include "recipe/recipe_json.h"
#include "synthesis/field/field_mesh.h"
#include "tasks/estimation/body_class.h"
#include "tasks/synth/synth.h"
#include "tests/support/meshes.h"
#include "tests/tasks/inputs.h"
#include "tests/tasks/job_runner.h"

namespace astrolith {
namespace {

using testing::ellipsoid_obj;
using testing::has;
using testing::Outcome;

// Recipes of a potato of three spheres, a longer one and a ball.
class FitPopulation : public testing::JobTest {
 protected:
  FitPopulation() : JobTest("fit_population", declare_fit_population) {
    write("potato.json", recipe("[[0, 0, 0, 1], [0.7, 0.2, 0, 0.7], [-0.5, 0.3, 0.2, 0.8]]"));
    write("long.json", recipe("[[0, 0, 0, 0.8], [0.9, 0, 0.1, 0.7], [-0.9, 0.1, 0, 0.7]]"));
    write("ball.json", recipe("[[3, 4, 5, 1], [3, 4, 5.2, 0.9]]"));
  }
  static std::string recipe(const std::string& spheres) {
    return R"({"format_version": 1, "length_unit": "km", "body": {"type": "metaballs", "a": 2, "b": 2, "spheres": )" +
           spheres + "}, \"layers\": []}";
  }
  Outcome synth(const std::string& line) const {
    return testing::run_job("synth", declare_synth, testing::split_words(line), folder_.path());
  }
};

TEST_F(FitPopulation, KnowsWhereBodiesLieAndWhatTheyLookLike) {
  write("table.csv", "name,source,class,rotation_period_h,density_kg_m3\npot,radar,top,4.3,1190\n");
  succeed("potato.json long.json ball.json -o p.json --table table.csv");
  const Recipe population = read_recipe(folder_ / "p.json");
  const auto& [potato, elongated, ball] = std::tie(
      population.population->bodies[0], population.population->bodies[1], population.population->bodies[2]);
  EXPECT_EQ(potato.kind, BodyClass::kTop);
  EXPECT_EQ(potato.source, ShapeSource::kRadar);
  EXPECT_EQ(potato.rotation_period, 4.3);
  EXPECT_EQ(potato.density, 1190.0);
  EXPECT_EQ(potato.name, "pot");
  EXPECT_EQ(elongated.kind, BodyClass::kElongated);
  EXPECT_EQ(ball.kind, BodyClass::kRounded);
  EXPECT_NEAR(ball.center.x, 3.0, 0.02);
  EXPECT_NEAR(ball.center.z, 5.1, 0.1);
  EXPECT_NEAR(ball.half_axes.x / ball.half_axes.z, 1.05, 0.06);
}

// A mesh is fitted; the population can be extended, and a body of the same name takes the other's place.
TEST_F(FitPopulation, FitsMeshesAndAddsToPopulations) {
  write("egg.obj", ellipsoid_obj(1.3, 1, 0.9, 21, 40));
  succeed("egg.obj potato.json -o p.astro --spheres 10 --unit m");
  succeed("egg.obj long.json -o q.astro --spheres 10 --add-to p.astro --summary s.json");
  const Recipe population = read_recipe(folder_ / "q.astro");
  ASSERT_EQ(population.population->bodies.size(), 3u);
  EXPECT_EQ(population.length_unit, "m");
  EXPECT_NEAR(population.population->bodies[0].half_axes.x, 1.3, 0.02);
  EXPECT_NEAR(population.population->bodies[2].unit, 1000.0, 0.0);
  EXPECT_NEAR(json("s.json")["bodies"][1]["diameter"].get<double>(), 2600.0, 500.0);
}

TEST_F(FitPopulation, RefusesWhatIsNoMeasuredBody) {
  write(
      "layers.json",
      R"({"format_version": 1, "length_unit": "m", "layers": [{"type": "simplex", "amplitude": 1, "frequency": 1}]})");
  refuse("layers.json potato.json -o p.json", "has no body");
  refuse("potato.json -o p.json", "give two or more");
  refuse("potato.json ./potato.json -o p.json", "potato is given twice");
  write("open.obj", "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n");
  refuse("open.obj potato.json -o p.json", "open.obj");
  write("t.csv", "who,source\na,b\n");
  refuse("potato.json ball.json -o p.json --table t.csv", "no column called name");
  write("u.csv", "name,source\nball,sonar\n");
  refuse("potato.json ball.json -o p.json --table u.csv",
         "u.csv: ball: source: must be one of camera, radar, adaptive_optics, light_curve, is sonar");
}

TEST_F(FitPopulation, GivesBodiesThatSynthDraws) {
  succeed("potato.json long.json ball.json -o p.astro");
  const Outcome one = synth(
      "p.astro -o one.ply --write-recipe one.json --resolution 24 --diameter 330+-20 --seed 4 --summary "
      "s.json");
  EXPECT_EQ(one.status, 0) << one.errors;
  EXPECT_TRUE(has(one.errors, "Drawn between"));
  EXPECT_EQ(json("s.json")["drawn_body"]["donors"].size(),
            read_recipe(folder_ / "one.json").body->morph->donors.size());
  EXPECT_EQ(synth("one.json -o again.ply --resolution 24").status, 0);
  EXPECT_EQ(read_mesh(folder_ / "again.ply").vertices, read_mesh(folder_ / "one.ply").vertices);
  const std::string set =
      "p.astro --members 0:3 -o b_{member}.ply --manifest m.jsonl --resolution 24 --axes 1.5:1.2:1 ";
  EXPECT_EQ(synth(set + "--threads 2").status, 0);
  const std::string both = text("b_0000001.ply");
  EXPECT_TRUE(has(text("m.jsonl"), "\"donors\""));
  EXPECT_EQ(
      synth("p.astro --members 1:2 -o c_{member}.ply --resolution 24 --axes 1.5:1.2:1 --threads 1").status,
      0);
  EXPECT_EQ(text("c_0000001.ply"), both);
  const auto refused = [&](const std::string& line, const std::string& words) {
    const Outcome outcome = synth(line);
    EXPECT_EQ(outcome.status, 2);
    EXPECT_TRUE(has(outcome.errors, words)) << outcome.errors;
  };
  refused("ball.json -o x.ply --diameter 3", "is one body");
  refused("p.astro -o x.ply --diameter 0", "--diameter: must be a diameter");
  refused("p.astro -o x.ply --axes 10:1:1", "ratio of 10");
  refused("p.astro -o x.ply --axes 2:1", "must be three numbers");
  refused("p.astro -o x.ply --class top", "0 of 3 bodies fulfil");
}

TEST(BodyClasses, FollowFromTheShape) {
  const auto classify_spheres = [](std::vector<Sphere> spheres, double exponent) {
    Recipe recipe;
    recipe.body = MetaballBody{};
    recipe.body->spheres = std::move(spheres);
    recipe.body->a = recipe.body->b = 2.0;
    recipe.body->blend_exponent = exponent;
    const TriangleMesh mesh = make_coarse_mesh(ImplicitField(recipe), 64);
    return classify_body(shape_features(mesh, body_frame(mesh)));
  };
  EXPECT_EQ(classify_spheres({{{0, 0, 0}, 1}, {{1.7, 0, 0}, 0.8}}, 4.0), BodyClass::kContactBinary);
  EXPECT_EQ(classify_spheres({{{0, 0, 0}, 1}, {{0.8, 0, 0}, 1}, {{-0.8, 0, 0}, 1}}, 4.0),
            BodyClass::kElongated);
  EXPECT_EQ(classify_spheres({{{0, 0, 0}, 1}}, 1.0), BodyClass::kRounded);
}

}  // namespace
}  // namespace astrolith
