// fit_shape: a mesh becomes a recipe.
#include "tasks/estimation/fit_shape.h"

#include "geometry/io/mesh_io.h"
#include "numerics/files/sha256.h"
#include "recipe/recipe_json.h"
#include "tests/support/data.h"
#include "tests/tasks/inputs.h"
#include "tests/tasks/job_runner.h"

namespace astrolith {
namespace {

using testing::has;

// egg.obj is a slender ellipsoid: its mesh at a fixed number of cells along it has few triangles.
class FitShape : public testing::JobTest {
 protected:
  FitShape() : JobTest("fit_shape", testing::make_job(declare_fit_options, fit_shape)) {
    write("egg.obj", testing::ellipsoid_obj(2.5, 0.7, 0.6, 15, 24));
  }
  std::string fit(const std::string& output, const std::string& more) {
    succeed("egg.obj -o " + output + " --spheres 12 --population 2 --generations 2 --points 400 " + more);
    return text(output);
  }
  // A recipe of the folder, and one to it.
  Recipe recipe(const std::string& name) const { return read_recipe(folder_ / name); }
  void put(const Recipe& recipe, const std::string& name) const { write_recipe(recipe, folder_ / name); }

  // Lays the layers on the egg.
  Recipe with_layers(const std::string& options) {
    succeed("egg.obj -o out.json --spheres 12 --points 400 --population 4 " + options);
    return recipe("out.json");
  }
};

GaborLayer gravel_layer() {
  GaborLayer gravel;
  gravel.name = "gravel";
  gravel.height_rms = 0.2;
  gravel.lobes.push_back({4, 0.1, 0.05, 0.04});
  return gravel;
}

// A boulder of 30 m in the frame of its asteroid, 16.5 km from the middle.
TEST_F(FitShape, ABodyFarFromTheOriginOfItsFrameGetsAnOriginOfItsOwn) {
  TriangleMesh boulder = read_mesh(folder_ / "egg.obj");
  for (Vec3d& p : boulder.vertices) p = Vec3d{16.5, 0, 0} + 0.01 * p;
  write_mesh(boulder, folder_ / "boulder.obj", {});
  const std::string said =
      succeed("boulder.obj -o far.json --spheres 12 --points 400 --base-only --summary s.json");
  EXPECT_TRUE(has(said, "the recipe has an origin of its own, 16.5 0 0 km"));
  EXPECT_LT(json("s.json")["mean_distance"], 0.02);
  const Recipe far = recipe("far.json");
  EXPECT_TRUE(far.origin == (Vec3d{16.5, 0, 0}));
  for (const Sphere& s : far.body->spheres) EXPECT_LT(norm(s.center), 0.05);
}

TEST_F(FitShape, WritesARecipeWithABody) {
  fit("egg.json", "--base-only --subtract 0 --summary s.json");
  const Recipe egg = recipe("egg.json");
  ASSERT_TRUE(egg.body.has_value());
  EXPECT_LE(egg.body->spheres.size(), 12u);
  EXPECT_TRUE(egg.body->subtract.empty());
  EXPECT_EQ(egg.provenance.input_name, "egg.obj");
  EXPECT_EQ(egg.provenance.input_sha256, file_sha256(folder_ / "egg.obj"));
  const auto summary = json("s.json");
  for (const char* field : {"spheres", "similarity", "evaluations", "seconds"}) {
    EXPECT_TRUE(summary.at(field).is_number()) << field;
  }
  // Fractions of the bounding-box diagonal.
  EXPECT_LT(summary["mean_distance"], 0.02);
  EXPECT_LE(summary["mean_distance"], summary["p99_distance"]);
  EXPECT_LE(summary["p99_distance"], summary["max_distance"]);
  EXPECT_NEAR(summary["volume_ratio"], 1.0, 0.05);
}

// A finer egg, which may have a relief.
class FitShapeRelief : public FitShape {
 protected:
  FitShapeRelief() { write("fine.obj", testing::ellipsoid_obj(2.5, 0.7, 0.6, 24, 32)); }
  nlohmann::json made(const std::string& options) const {
    return figures("fine.obj -o out.astro --population 2 --points 400 --noise-seeds 0 " + options);
  }
};

TEST_F(FitShapeRelief, BytesHoldMetaballsAndHeights) {
  const auto summary = made("--details relief --spheres 6 --bytes 900");
  EXPECT_LE(text("out.astro").size(), 900u);
  EXPECT_GE(summary.at("relief").at("heights"), 100);
  EXPECT_LT(summary["mean_distance"], 0.5 * summary["base"]["mean_distance"].get<double>());
}

TEST_F(FitShapeRelief, FewBytesAreMetaballsAloneTheSameInBothForms) {
  EXPECT_FALSE(made("--bytes 200").contains("relief"));
  EXPECT_LE(text("out.astro").size(), 200u);
  EXPECT_EQ(text("out.astro").substr(0, 3), "AST");
  succeed("fine.obj -o out.json --population 2 --points 400 --noise-seeds 0 --bytes 200");
  EXPECT_EQ(recipe_to_json(recipe("out.astro")), text("out.json"));
}

TEST_F(FitShapeRelief, SpacingsThatTheModelDoesNotBearAreRefusedBeforeTheFit) {
  refuse_all("fine.obj -o out.json --relief-spacing ", {{"0.1edges", "and this model bears"},
                                                        {"1e-9", "and this model bears"},
                                                        {"10km", "and this model bears"}});
  refuse("fine.obj -o out.json --details relief --bytes 100", "hold no heights beside metaballs");
  refuse("egg.obj -o out.json --relief-spacing 1", "of at least 1000 facets");
}

TEST_F(FitShapeRelief, ASpacingOfAutoIsTheDefault) {
  made("--details relief --spheres 6");
  const std::string without = recipe_to_json(recipe("out.astro"));
  made("--details relief --spheres 6 --relief-spacing auto");
  Recipe with = recipe("out.astro");
  std::erase_if(with.provenance.options, [](const auto& option) { return option.first == "relief-spacing"; });
  EXPECT_EQ(recipe_to_json(with), without);
}

TEST_F(FitShape, ARealBodyIsFittedCloselyLong) {
  const auto gaspra = testing::package_file("gaspra.bmf");
  ASTROLITH_SKIP_WITHOUT(gaspra);
  succeed(gaspra.string() +
          " -o gaspra.json --spheres 60 --population 8 --generations 4 --summary s.json --report report");
  const auto summary = json("s.json");
  EXPECT_TRUE(summary["closed"]);
  EXPECT_TRUE(summary["manifold"]);
  EXPECT_EQ(summary["components"], 1);
  EXPECT_LT(summary["base"]["mean_distance"], 0.002);
  EXPECT_NEAR(summary["volume_ratio"], 1.0, 0.01);
  EXPECT_EQ(recipe("gaspra.json").body->subtract.size(), summary["subtracting_spheres"]);
  EXPECT_GT(summary["subtracting_spheres"], 0);
  EXPECT_EQ(summary["details"]["evaluations"], 32);
  EXPECT_LT(summary["details"]["best"]["roughness_misfit"], summary["details"]["base"]["roughness_misfit"]);
  EXPECT_TRUE(exists("report/distance_map.png"));
}

TEST_F(FitShape, PackingOnlyWritesATableOfMascons) {
  succeed("egg.obj -o egg.csv --spheres 12 --packing-only --density 2000");
  const std::string table = text("egg.csv");
  EXPECT_TRUE(has(table, "x,y,z,radius,mass\n"));
  EXPECT_EQ(std::count(table.begin(), table.end(), '\n'), 3 + 12);
}

TEST_F(FitShape, SameBytesForAnyThreadCountAndAnotherSeedAnotherFitLong) {
  const std::string one = fit("one.json", "--threads 1 --seed 3");
  EXPECT_EQ(one, fit("two.json", "--threads 2 --seed 3"));
  fit("other.json", "--base-only --seed 4");
  EXPECT_NE(recipe("one.json").body->spheres.at(0).radius, recipe("other.json").body->spheres.at(0).radius);
}

TEST_F(FitShape, AResumedFitIsThatOfARunWithoutAStopLong) {
  const std::string whole = fit("whole.json", "--checkpoint stop.checkpoint");
  // The checkpoint of a run that stopped after the base and one candidate.
  auto checkpoint = nlohmann::ordered_json::parse(text("stop.checkpoint"));
  ASSERT_EQ(checkpoint["evaluations"].size(), 4u);
  while (checkpoint["evaluations"].size() > 1) checkpoint["evaluations"].erase(1);
  write("stop.checkpoint", checkpoint.dump());
  EXPECT_EQ(fit("resumed.json", "--checkpoint stop.checkpoint"), whole);
  EXPECT_EQ(json("stop.checkpoint")["evaluations"].size(), 4u);
}

TEST_F(FitShape, CheckpointsOfSomethingElseAndDamagedOnesAreRefused) {
  fit("egg.json", "--base-only --checkpoint stop.checkpoint");
  const std::string good = text("stop.checkpoint");
  const auto refuse_checkpoint = [&](const std::string& content, const std::string& culprit) {
    write("stop.checkpoint", content);
    refuse(
        "egg.obj -o no.json --spheres 12 --base-only --population 2 --points 400 --checkpoint "
        "stop.checkpoint",
        culprit);
  };
  for (const std::string& content :
       {good,  // --generations was given then
        good.substr(0, good.size() / 2), std::string(), std::string("[1, 2, 3]"),
        std::string("{\"astrolith_checkpoint\": 1}"), std::string(100000, '[')}) {
    refuse_checkpoint(content, "stop.checkpoint");
  }
  // No whole numbers of 64 bits, in the checkpoint of this fit.
  for (const double number : {4.6e21, -1.0, 0.5}) {
    auto checkpoint = nlohmann::ordered_json::parse(good);
    checkpoint["evaluations"] = {{1, number}};
    write("stop.checkpoint", checkpoint.dump());
    refuse(
        "egg.obj -o no.json --spheres 12 --population 2 --generations 2 --points 400 --base-only "
        "--checkpoint "
        "stop.checkpoint",
        "stop.checkpoint: is no checkpoint, or damaged");
  }
  // What other code wrote.
  const auto written = nlohmann::ordered_json::parse(good);
  const std::string own = written["of"]["tool"], old = "fit_shape 0.2.0 (0000000)";
  for (const auto& [key, value, culprit] :
       {std::tuple{"tool", old, old + ", and this is " + own + "; go on"},
        {"tool", own + ", modified", own + ", modified, and this is " + own + "; go on"},
        {"changes", "0123456789abcdef", own + ", whose source has been modified since; go on"}}) {
    auto checkpoint = written;
    checkpoint["of"][key] = value;
    refuse_checkpoint(checkpoint.dump(), "written by " + culprit);
  }
}

TEST_F(FitShape, DetailsOfAnotherBodyAreScaledToThisOne) {
  Recipe other;
  other.body.emplace().spheres.push_back({{0, 0, 0}, 10.0});
  put(other, "bare.json");
  FractalLayer hills;
  hills.amplitude = 1.0;
  hills.frequency = 0.5;
  other.layers.push_back(hills);
  put(other, "other.json");
  const Recipe made = with_layers("--details other.json");
  ASSERT_EQ(made.layers.size(), 1u);
  const auto& layer = std::get<FractalLayer>(made.layers[0]);
  // Half axes 2.5, 0.7, 0.6 beside a ball of radius 10.
  const double ratio = std::sqrt(2.5 * 2.5 + 0.7 * 0.7 + 0.6 * 0.6) / std::sqrt(300.0);
  EXPECT_NEAR(layer.amplitude, ratio, 0.1 * ratio);
  EXPECT_NEAR(layer.frequency * layer.amplitude, 0.5, 1e-9);
  refuse("egg.obj -o no.json --details bare.json", "bare.json");
}

TEST_F(FitShape, MicroLayersGetTheirScaleFromTheOptions) {
  Recipe rock;
  rock.length_unit = "px";
  rock.layers.push_back(gravel_layer());
  put(rock, "rock.json");
  refuse("egg.obj -o no.json --spheres 12 --base-only --micro rock.json", "--mm-per-px");
  const Recipe made = with_layers("--base-only --micro rock.json --mm-per-px 20000 --micro-height 3000");
  const auto& layer = std::get<GaborLayer>(made.layers.at(0));
  EXPECT_NEAR(layer.pixel_size, 0.02, 1e-12);  // km
  EXPECT_NEAR(layer.height_rms, 0.003, 1e-12);
}

// Refused before the mesh is read: the mesh does not exist here.
TEST_F(FitShape, LayersThatAFittedBodyCannotHaveAreRefusedBeforeAnyWork) {
  Recipe rock;
  rock.body.emplace().spheres.push_back({{0, 0, 0}, 1.0});
  rock.body->groups.push_back({"head", {0}});
  FractalLayer waves;
  waves.name = "waves";
  waves.amplitude = 0.1;
  rock.layers = {waves, gravel_layer()};
  Recipe grouped = rock;
  find_use(grouped.layers[1])->locality = {"head", 0.5};
  put(grouped, "grouped.json");
  for (const std::string option : {"--micro", "--details"}) {
    refuse("none.obj -o no.json " + option + " grouped.json",
           option +
               ": grouped.json: layers[1].locality.group: a fitted body has no groups; take `locality` "
               "out of the layer");
  }
  find_use(rock.layers[1])->mask = {"waves", 0.0, 0.1};
  put(rock, "masked.json");
  refuse("none.obj -o no.json --micro masked.json",
         "layers[1].mask.layer: names a layer that is no Gabor layer");
}

// Heights of a mask and of a joint are heights of the layers.
TEST_F(FitShape, MicroLayersScaleTheirMasksAndJointsWithTheirHeights) {
  Recipe rock;
  rock.length_unit = "m";
  GaborLayer gravel = gravel_layer();
  gravel.pixel_size = 20.0;
  gravel.height_rms = 2.0;
  GaborLayer sand = gravel;
  sand.name = "sand";
  sand.use.mask = {"gravel", 1.0, 2.0};
  sand.use.combination.kind = Combine::kBlend;
  sand.use.combination.width = 1.0;
  rock.layers = {gravel, sand};
  put(rock, "rock.json");
  const Recipe made = with_layers("--base-only --micro rock.json");
  const auto& layer = std::get<GaborLayer>(made.layers.at(1));
  EXPECT_NEAR(layer.height_rms, 0.002, 1e-12);  // km
  EXPECT_NEAR(layer.use.mask->from, 0.001, 1e-12);
  EXPECT_NEAR(layer.use.mask->to, 0.002, 1e-12);
  EXPECT_NEAR(layer.use.combination.width, 0.001, 1e-12);
}

// The preparation of the mesh has no result that could be written.
TEST_F(FitShape, ATimeLimitBelowThePreparationIsRefusedWithTheTimeThatItNeeds) {
  write("large.obj", testing::ellipsoid_obj(1.5, 1.1, 0.9, 150, 200));
  refuse("large.obj -o out.json --time-limit 0.001", "--time-limit");
}

TEST_F(FitShape, VariationsAreAsAlikeAsAskedLong) {
  fit("egg.json", "--base-only --variations 2 --delta 0.8 --summary s.json");
  const auto figures = json("s.json")["variations"];
  ASSERT_EQ(figures.size(), 2u);
  for (std::size_t k = 1; k <= 2; ++k) {
    const auto achieved = recipe("egg_variation_" + std::to_string(k) + ".json").provenance.achieved;
    ASSERT_EQ(achieved.size(), 4u);
    EXPECT_EQ(achieved[0].first, "similarity");
    EXPECT_GE(achieved[0].second, 0.2 - 1e-6);
    EXPECT_EQ(achieved[2].first, "variation_mean_distance");
    EXPECT_GE(achieved[2].second, 1e-4 - 1e-10);
    EXPECT_NEAR(figures[k - 1]["mean_distance"], achieved[2].second, 1e-6);
    EXPECT_GT(figures[k - 1]["strength"], 0.0);
  }
}

TEST_F(FitShape, TakesTheUnitThatTheMeshStatesAndAsksBack) {
  const std::string egg = testing::ellipsoid_obj(9.0, 8.0, 8.0, 15, 24);
  for (const char* name : {"eros.obj", "erosion.obj"}) write(name, egg);
  for (const std::string unit : {"m", "cm"}) write(unit + ".obj", "# length unit: " + unit + "\n" + egg);
  const auto said = [&](const std::string& mesh) {
    return succeed(mesh + " -o t.csv --packing-only --spheres 2");
  };
  EXPECT_FALSE(has(said("eros.obj"), "mean radius"));
  EXPECT_TRUE(has(said("eros.obj --unit m"), "mean radius"));
  EXPECT_FALSE(has(said("erosion.obj --unit m"), "mean radius"));
  said("m.obj");
  EXPECT_TRUE(has(text("t.csv"), "lengths in m"));
  EXPECT_TRUE(has(said("m.obj --unit km"), "note: m.obj: states its unit as m; taken in km"));
  EXPECT_TRUE(has(text("t.csv"), "lengths in km"));
  refuse("cm.obj -o c.csv --packing-only",
         "cm.obj: states its unit as cm, which is none of km, m; convert its lengths");
}

TEST_F(FitShape, MeshesThatCanBeMendedAreFitted) {
  const auto said = [&](const std::string& content) {
    return succeed(write("mesh.obj", content) + " -o t.csv --packing-only --spheres 2");
  };
  EXPECT_TRUE(has(said(testing::kInsideOut), "turned 4 facets"));
  EXPECT_TRUE(
      has(said(testing::kTetrahedronVertices + "v 0 0 0\nv 1 0 0\nf 1 3 2\nf 5 2 4\nf 1 4 3\nf 6 3 4\n"),
          "2 repeated"));
  said("v 0 0 0\nv 1e-6 0 0\nv 0 1e-6 0\nv 0 0 1e-6\nf 1 3 2\nf 1 2 4\nf 1 4 3\nf 2 3 4\n");
}

TEST_F(FitShape, DamagedMeshesAreRepaired) {
  const std::string egg = testing::ellipsoid_obj(1.2, 1, 0.9, 24, 36);
  const std::string end = " -o t.csv --packing-only --spheres 4 --summary s.json";
  write("holed.obj", egg.substr(0, egg.rfind("f ")));
  EXPECT_TRUE(has(succeed("holed.obj" + end), "holed.obj: filled 1 hole (largest"));
  EXPECT_EQ(json("s.json")["repair"]["holes"], 1);
  refuse("holed.obj --strict" + end, "holed.obj");
  succeed(write("whole.obj", egg) + end);
  EXPECT_FALSE(json("s.json").contains("repair"));
  // A third of the facets, all at one end.
  std::size_t cut = egg.find("f ");
  for (int line = 0; line < 500; ++line) cut = egg.find("f ", cut + 1);
  write("half.obj", egg.substr(0, cut));
  refuse("half.obj" + end, "add --wrap");
}

TEST_F(FitShape, PointsAreWrappedLong) {
  std::string points;
  std::istringstream egg(testing::ellipsoid_obj(1.2, 1, 0.9, 40, 60));
  for (std::string line; std::getline(egg, line);) {
    if (line.starts_with("v ")) points += line.substr(2) + "\n";
  }
  write("egg.xyz", points);
  const std::string end = " -o t.csv --packing-only --spheres 4";
  refuse("egg.xyz" + end, "egg.xyz");
  EXPECT_TRUE(has(succeed("egg.xyz --wrap" + end), "egg.xyz: surface through"));
}

TEST_F(FitShape, BadMeshesAreRefused) {
  for (const auto& [name, content] : std::vector<std::pair<std::string, std::string>>{
           {"cut.ply", testing::truncated_ply()},
           {"open.obj", testing::kTetrahedronVertices + "f 1 3 2\nf 1 2 4\nf 1 4 3\n"},
           {"points.obj", testing::kTetrahedronVertices},
           {"flat.obj", "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\nf 1 3 2\n"}}) {
    refuse(write(name, content) + " -o out.json --spheres 4", name);
  }
}

// Options that contradict each other are refused before the mesh is read: none.obj does not exist.
TEST_F(FitShape, BadFilesAndOddOptionsAreRefused) {
  std::filesystem::create_directory(folder_ / "folder");
  refuse_all("", {{"absent.obj -o out.json", "absent.obj"},
                  {"folder -o out.json", "folder"},
                  {"egg.obj -o absent/out.json", "out.json"},
                  {"egg.obj -o folder", "folder"},
                  {"egg.obj -o o.json --report egg.obj/report", "report"},
                  {"egg.obj -o o.json --spheres 0", "--spheres"},
                  {"egg.obj -o o.json --optimizer magic", "--optimizer"},
                  {"egg.obj -o o.json --density 2000", "--packing-only"},
                  {"egg.obj -o o.csv --packing-only --points 500", "excludes"},
                  {"egg.obj -o o.json --details thesis --bytes 500",
                   "to which other details would add; add --base-only"},
                  {"none.obj -o o.json --details relief --generations 3",
                   "--generations: are those of --details thesis"},
                  {"none.obj -o o.json --details relief --base-only", "excludes"}});
}

}  // namespace
}  // namespace astrolith
