// fit_shape, run as a user runs it.
#include <algorithm>
#include <nlohmann/json.hpp>

#include "recipe/recipe_json.h"
#include "recipe/sha256.h"
#include "tests/apps/inputs.h"
#include "tests/apps/program_runner.h"
#include "tests/support/data.h"

namespace astrolith {
namespace {

using testing::expect_refusal;
using testing::run_program;
using testing::text_of;
using testing::WorkFolder;

const std::string kFitShape = ASTROLITH_FIT_SHAPE;

class FitShape : public ::testing::Test {
 protected:
  std::string fit(const std::string& output, std::vector<std::string> more) {
    const std::string file = (folder_ / output).string();
    std::vector<std::string> arguments{
        folder_.write("egg.obj", testing::ellipsoid_obj(1.5, 1.1, 0.9, 15, 24)),
        "-o",
        file,
        "--spheres",
        "12",
        "--population",
        "4",
        "--generations",
        "2",
        "--points",
        "400"};
    arguments.insert(arguments.end(), more.begin(), more.end());
    const testing::Outcome outcome = run_program(kFitShape, arguments);
    EXPECT_EQ(outcome.status, 0) << outcome.errors;
    return text_of(file);
  }
  void expect_mesh_refused(const std::string& name, const std::string& content) {
    const std::string file = folder_.write(name, content);
    expect_refusal(folder_, kFitShape, {file, "-o", (folder_ / "out.json").string(), "--spheres", "4"}, name);
  }

  WorkFolder folder_;
};

TEST_F(FitShape, WritesARecipeWithABody) {
  fit("egg.json", {"--base-only"});
  const Recipe recipe = read_recipe(folder_ / "egg.json");
  ASSERT_TRUE(recipe.body.has_value());
  EXPECT_LE(recipe.body->spheres.size(), 12u);
  EXPECT_EQ(recipe.provenance.input_name, "egg.obj");
  EXPECT_EQ(recipe.provenance.input_sha256, sha256_of_file(folder_ / "egg.obj"));
}

TEST_F(FitShape, WritesACompactRecipeOfAtMostTheBytes) {
  const std::string compact = fit("egg.astro", {"--base-only", "--bytes", "140"});
  EXPECT_LE(compact.size(), 140u);
  EXPECT_EQ(compact.substr(0, 3), "AST");
  const std::string text = fit("egg.json", {"--base-only", "--bytes", "140"});
  EXPECT_EQ(recipe_to_json(read_recipe(folder_ / "egg.astro")), text);
}

TEST_F(FitShape, NoSphereTakesAwayWhereNoneMay) {
  fit("egg.json", {"--base-only", "--subtract", "0"});
  const Recipe recipe = read_recipe(folder_ / "egg.json");
  EXPECT_TRUE(recipe.body->subtract.empty());
}

TEST_F(FitShape, ARealBodyIsFittedClosely) {
  const auto gaspra = testing::package_file("gaspra.bmf");
  ASTROLITH_SKIP_WITHOUT(gaspra);
  const std::string summary_file = (folder_ / "s.json").string();
  const testing::Outcome outcome =
      run_program(kFitShape, {gaspra.string(), "-o", (folder_ / "gaspra.json").string(), "--spheres", "60",
                              "--population", "8", "--generations", "4", "--summary", summary_file,
                              "--report", (folder_ / "report").string()});
  ASSERT_EQ(outcome.status, 0) << outcome.errors;
  const auto summary = nlohmann::json::parse(text_of(summary_file));
  EXPECT_TRUE(summary["closed"].get<bool>());
  EXPECT_TRUE(summary["manifold"].get<bool>());
  EXPECT_EQ(summary["components"].get<int>(), 1);
  EXPECT_LT(summary["base"]["mean_distance"].get<double>(), 0.002);
  EXPECT_NEAR(summary["volume_ratio"].get<double>(), 1.0, 0.01);
  EXPECT_EQ(read_recipe(folder_ / "gaspra.json").body->subtract.size(),
            summary["subtracting_spheres"].get<std::size_t>());
  EXPECT_GT(summary["subtracting_spheres"].get<int>(), 0);
  EXPECT_EQ(summary["details"]["evaluations"].get<int>(), 32);
  EXPECT_LT(summary["details"]["best"]["roughness_misfit"].get<double>(),
            summary["details"]["base"]["roughness_misfit"].get<double>());
  EXPECT_TRUE(std::filesystem::exists(folder_ / "report" / "distance_map.png"));
}

TEST_F(FitShape, PackingOnlyWritesATableOfMascons) {
  const std::string mesh = folder_.write("egg.obj", testing::ellipsoid_obj(1.5, 1.1, 0.9, 15, 24));
  const std::string file = (folder_ / "egg.csv").string();
  const testing::Outcome outcome =
      run_program(kFitShape, {mesh, "-o", file, "--spheres", "12", "--packing-only", "--density", "2000"});
  EXPECT_EQ(outcome.status, 0) << outcome.errors;
  const std::string table = text_of(file);
  EXPECT_NE(table.find("x,y,z,radius,mass\n"), std::string::npos);
  EXPECT_EQ(std::count(table.begin(), table.end(), '\n'), 3 + 12);
  expect_refusal(folder_, kFitShape, {mesh, "-o", (folder_ / "no.json").string(), "--density", "2000"},
                 "--packing-only");
  expect_refusal(folder_, kFitShape,
                 {mesh, "-o", (folder_ / "no.csv").string(), "--packing-only", "--points", "500"},
                 "excludes");
}

TEST_F(FitShape, SameBytesForAnyThreadCountAndAnotherSeedAnotherFit) {
  const std::string one = fit("one.json", {"--threads", "1", "--seed", "3"});
  EXPECT_EQ(one, fit("two.json", {"--threads", "2", "--seed", "3"}));
  const Recipe a = parse_recipe(one, "one.json"),
               b = parse_recipe(fit("other.json", {"--base-only", "--seed", "4"}), "other.json");
  EXPECT_NE(a.body->spheres.at(0).radius, b.body->spheres.at(0).radius);
}

TEST_F(FitShape, AResumedFitIsThatOfARunWithoutAStop) {
  const std::string file = (folder_ / "stop.checkpoint").string();
  const std::string whole = fit("whole.json", {"--checkpoint", file});
  // The checkpoint of a run that stopped after the base and one candidate.
  auto checkpoint = nlohmann::ordered_json::parse(text_of(file));
  ASSERT_EQ(checkpoint["evaluations"].size(), 8u);
  while (checkpoint["evaluations"].size() > 1) checkpoint["evaluations"].erase(1);
  folder_.write("stop.checkpoint", checkpoint.dump());
  EXPECT_EQ(fit("resumed.json", {"--checkpoint", file}), whole);
  EXPECT_EQ(nlohmann::json::parse(text_of(file))["evaluations"].size(), 8u);
}

TEST_F(FitShape, CheckpointsOfSomethingElseAndDamagedOnesAreRefused) {
  const std::string file = (folder_ / "stop.checkpoint").string();
  fit("egg.json", {"--base-only", "--checkpoint", file});
  const std::string mesh = (folder_ / "egg.obj").string(), good = text_of(file);
  const auto refuse = [&](const std::string& content) {
    folder_.write("stop.checkpoint", content);
    expect_refusal(folder_, kFitShape,
                   {mesh, "-o", (folder_ / "no.json").string(), "--spheres", "12", "--base-only",
                    "--population", "4", "--points", "400", "--checkpoint", file},
                   "stop.checkpoint");
  };
  refuse(good);  // --generations was given then
  refuse(good.substr(0, good.size() / 2));
  refuse("");
  refuse("[1, 2, 3]");
  refuse("{\"astrolith_checkpoint\": 1}");
  refuse(std::string(100000, '['));
}

TEST_F(FitShape, CheckpointsThatOtherCodeWroteAreRefused) {
  const std::string file = (folder_ / "stop.checkpoint").string();
  fit("egg.json", {"--base-only", "--checkpoint", file});
  const auto written = nlohmann::ordered_json::parse(text_of(file));
  const auto refuse = [&](const std::string& key, const std::string& value, const std::string& culprit) {
    auto checkpoint = written;
    checkpoint["of"][key] = value;
    folder_.write("stop.checkpoint", checkpoint.dump());
    expect_refusal(
        folder_, kFitShape,
        {(folder_ / "egg.obj").string(), "-o", (folder_ / "no.json").string(), "--checkpoint", file},
        culprit);
  };
  const std::string own = written["of"]["tool"];
  refuse("tool", "fit_shape 0.2.0 (0000000)",
         "written by fit_shape 0.2.0 (0000000), and this is " + own + "; go on");
  refuse("tool", own + ", modified", "written by " + own + ", modified, and this is " + own + "; go on");
  refuse("changes", "0123456789abcdef",
         "written by " + own + ", whose source has been modified since; go on");
}

TEST_F(FitShape, DetailsOfAnotherBodyAreScaledToThisOne) {
  fit("egg.json", {"--base-only"});
  Recipe other;
  other.body.emplace().spheres.push_back({{0, 0, 0}, 10.0});
  FractalLayer hills;
  hills.amplitude = 1.0;
  hills.frequency = 0.5;
  other.layers.push_back(hills);
  write_recipe(other, folder_ / "other.json");
  const std::string mesh = (folder_ / "egg.obj").string(), out = (folder_ / "out.json").string();
  const testing::Outcome outcome =
      run_program(kFitShape, {mesh, "-o", out, "--spheres", "12", "--points", "400", "--population", "4",
                              "--details", (folder_ / "other.json").string()});
  ASSERT_EQ(outcome.status, 0) << outcome.errors;
  const Recipe made = read_recipe(out);
  ASSERT_EQ(made.layers.size(), 1u);
  const auto& layer = std::get<FractalLayer>(made.layers[0]);
  // Half axes 1.5, 1.1, 0.9 beside a ball of radius 10.
  const double ratio = std::sqrt(1.5 * 1.5 + 1.1 * 1.1 + 0.9 * 0.9) / std::sqrt(300.0);
  EXPECT_NEAR(layer.amplitude, ratio, 0.1 * ratio);
  EXPECT_NEAR(layer.frequency * layer.amplitude, 0.5, 1e-9);
  expect_refusal(folder_, kFitShape,
                 {mesh, "-o", (folder_ / "no.json").string(), "--details", (folder_ / "egg.json").string()},
                 "egg.json");
}

TEST_F(FitShape, OptionsOfAnotherSearchForDetailsAreRefusedBeforeAnyWork) {
  const std::string none = (folder_ / "none.obj").string(), out = (folder_ / "no.json").string();
  expect_refusal(folder_, kFitShape, {none, "-o", out, "--details", "learnt", "--generations", "3"},
                 "--generations: are those of --details thesis");
  expect_refusal(folder_, kFitShape, {none, "-o", out, "--everywhere"},
                 "--everywhere: goes with --details learnt");
  expect_refusal(folder_, kFitShape, {none, "-o", out, "--details", "learnt", "--base-only"}, "excludes");
}

// The egg has too few triangles to say what its surface is like.
TEST_F(FitShape, WithoutSurfaceStatisticsNothingIsLearntAndTheBaseIsWritten) {
  const std::string mesh = folder_.write("egg.obj", testing::ellipsoid_obj(1.5, 1.1, 0.9, 15, 24));
  const std::string out = (folder_ / "egg.json").string();
  const testing::Outcome outcome =
      run_program(kFitShape, {mesh, "-o", out, "--spheres", "12", "--points", "400", "--details", "learnt"});
  EXPECT_EQ(outcome.status, 0) << outcome.errors;
  EXPECT_NE(outcome.errors.find("no details are learnt"), std::string::npos) << outcome.errors;
  EXPECT_TRUE(read_recipe(out).layers.empty());
}

TEST_F(FitShape, MicroLayersGetTheirScaleFromTheOptions) {
  fit("egg.json", {"--base-only"});
  Recipe rock;
  rock.length_unit = "px";
  GaborLayer gravel;
  gravel.height_rms = 0.2;
  gravel.lobes.push_back({4, 0.1, 0.05, 0.04});
  rock.layers.push_back(gravel);
  write_recipe(rock, folder_ / "rock.json");
  const std::string mesh = (folder_ / "egg.obj").string(), out = (folder_ / "out.json").string();
  std::vector<std::string> arguments{mesh, "-o",          out,       "--spheres",
                                     "12", "--points",    "400",     "--population",
                                     "4",  "--base-only", "--micro", (folder_ / "rock.json").string()};
  arguments[2] = (folder_ / "no.json").string();
  expect_refusal(folder_, kFitShape, arguments, "--mm-per-px");
  arguments[2] = out;
  for (const char* more : {"--mm-per-px", "20000", "--micro-height", "3000"}) arguments.push_back(more);
  const testing::Outcome outcome = run_program(kFitShape, arguments);
  ASSERT_EQ(outcome.status, 0) << outcome.errors;
  const Recipe made = read_recipe(out);
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
  GaborLayer gravel;
  gravel.height_rms = 0.2;
  gravel.lobes.push_back({4, 0.1, 0.05, 0.04});
  rock.layers = {waves, gravel};
  const auto refuse = [&](const std::string& option, const Recipe& recipe, const std::string& words) {
    write_recipe(recipe, folder_ / "rock.json");
    expect_refusal(folder_, kFitShape,
                   {(folder_ / "none.obj").string(), "-o", (folder_ / "no.json").string(), option,
                    (folder_ / "rock.json").string()},
                   words);
  };
  Recipe grouped = rock;
  use_of(grouped.layers[1])->locality = {"head", 0.5};
  for (const std::string option : {"--micro", "--details"}) {
    refuse(option, grouped,
           option + ": " + (folder_ / "rock.json").string() +
               ": layers[1].locality.group: a fitted body has no groups; take `locality` out of the layer");
  }
  Recipe masked = rock;
  use_of(masked.layers[1])->mask = {"waves", 0.0, 0.1};
  refuse("--micro", masked, "layers[1].mask.layer: names a layer that is no Gabor layer");
}

// Heights of a mask and of a joint are heights of the layers.
TEST_F(FitShape, MicroLayersScaleTheirMasksAndJointsWithTheirHeights) {
  fit("egg.json", {"--base-only"});
  Recipe rock;
  rock.length_unit = "m";
  GaborLayer gravel;
  gravel.name = "gravel";
  gravel.pixel_size = 20.0;
  gravel.height_rms = 2.0;
  gravel.lobes.push_back({4, 0.1, 0.05, 0.04});
  GaborLayer sand = gravel;
  sand.name = "sand";
  sand.use.mask = {"gravel", 1.0, 2.0};
  sand.use.combination.kind = Combine::kBlend;
  sand.use.combination.width = 1.0;
  rock.layers = {gravel, sand};
  write_recipe(rock, folder_ / "rock.json");
  const std::string mesh = (folder_ / "egg.obj").string(), out = (folder_ / "out.json").string();
  const testing::Outcome outcome =
      run_program(kFitShape, {mesh, "-o", out, "--spheres", "12", "--points", "400", "--population", "4",
                              "--base-only", "--micro", (folder_ / "rock.json").string()});
  ASSERT_EQ(outcome.status, 0) << outcome.errors;
  const auto& layer = std::get<GaborLayer>(read_recipe(out).layers.at(1));
  EXPECT_NEAR(layer.height_rms, 0.002, 1e-12);  // km
  EXPECT_NEAR(layer.use.mask->from, 0.001, 1e-12);
  EXPECT_NEAR(layer.use.mask->to, 0.002, 1e-12);
  EXPECT_NEAR(layer.use.combination.width, 0.001, 1e-12);
}

// The preparation of the mesh has no result that could be written.
TEST_F(FitShape, ATimeLimitBelowThePreparationIsRefusedWithTheTimeThatItNeeds) {
  const std::string mesh = folder_.write("large.obj", testing::ellipsoid_obj(1.5, 1.1, 0.9, 150, 200));
  const std::string out = (folder_ / "out.json").string();
  expect_refusal(folder_, kFitShape, {mesh, "-o", out, "--time-limit", "0.001"}, "--time-limit");
  EXPECT_FALSE(std::filesystem::exists(out));
}

TEST_F(FitShape, VariationsAreAsAlikeAsAsked) {
  const std::string summary_file = (folder_ / "s.json").string();
  fit("egg.json", {"--base-only", "--variations", "2", "--delta", "0.3", "--summary", summary_file});
  const auto figures = nlohmann::json::parse(text_of(summary_file))["variations"];
  ASSERT_EQ(figures.size(), 2u);
  for (int k = 1; k <= 2; ++k) {
    const Recipe variation = read_recipe(folder_ / ("egg_variation_" + std::to_string(k) + ".json"));
    const auto& achieved = variation.provenance.achieved;
    ASSERT_EQ(achieved.size(), 4u);
    EXPECT_EQ(achieved[0].first, "similarity");
    EXPECT_GE(achieved[0].second, 0.7 - 1e-6);
    EXPECT_EQ(achieved[2].first, "variation_mean_distance");
    EXPECT_GE(achieved[2].second, 1e-4 - 1e-10);
    const auto& stated = figures.at(static_cast<std::size_t>(k) - 1);
    EXPECT_NEAR(stated["mean_distance"].get<double>(), achieved[2].second, 1e-6);
    EXPECT_GT(stated["strength"].get<double>(), 0.0);
  }
}

TEST_F(FitShape, SummaryHoldsTheFigures) {
  fit("egg.json", {"--base-only", "--summary", (folder_ / "s.json").string()});
  const auto summary = nlohmann::json::parse(text_of(folder_ / "s.json"));
  for (const char* field : {"spheres", "similarity", "mean_distance", "p99_distance", "max_distance",
                            "volume_ratio", "evaluations", "seconds"}) {
    ASSERT_TRUE(summary.contains(field)) << field;
    EXPECT_TRUE(summary[field].is_number()) << field;
  }
  // Fractions of the bounding-box diagonal.
  EXPECT_LT(summary["mean_distance"].get<double>(), 0.02);
  EXPECT_LE(summary["mean_distance"].get<double>(), summary["p99_distance"].get<double>());
  EXPECT_LE(summary["p99_distance"].get<double>(), summary["max_distance"].get<double>());
  EXPECT_NEAR(summary["volume_ratio"].get<double>(), 1.0, 0.05);
}

TEST_F(FitShape, SaysWhenTheNameOfTheBodyDoesNotGoWithTheUnit) {
  const std::string table = (folder_ / "t.csv").string();
  const auto errors_for = [&](const std::string& name, std::vector<std::string> more) {
    std::vector<std::string> arguments{folder_.write(name, testing::ellipsoid_obj(9.0, 8.0, 8.0, 15, 24)),
                                       "-o",
                                       table,
                                       "--packing-only",
                                       "--spheres",
                                       "2"};
    arguments.insert(arguments.end(), more.begin(), more.end());
    const testing::Outcome outcome = run_program(kFitShape, arguments);
    EXPECT_EQ(outcome.status, 0) << outcome.errors;
    return outcome.errors;
  };
  EXPECT_EQ(errors_for("eros.obj", {}).find("mean radius"), std::string::npos);
  EXPECT_NE(errors_for("eros.obj", {"--unit", "m"}).find("mean radius"), std::string::npos);
  EXPECT_EQ(errors_for("erosion.obj", {"--unit", "m"}).find("mean radius"), std::string::npos);
}

TEST_F(FitShape, MeshesThatCanBeMendedAreFitted) {
  const auto errors_for = [&](const std::string& name, const std::string& content) {
    const testing::Outcome outcome =
        run_program(kFitShape, {folder_.write(name, content), "-o", (folder_ / "t.csv").string(),
                                "--packing-only", "--spheres", "2"});
    EXPECT_EQ(outcome.status, 0) << outcome.errors;
    return outcome.errors;
  };
  const std::string inside_out = "v 0 0 0\nv 1 0 0\nv 0 1 0\nv 0 0 1\nf 1 2 3\nf 1 4 2\nf 1 3 4\nf 2 4 3\n";
  EXPECT_NE(errors_for("inside_out.obj", inside_out).find("inside out"), std::string::npos);
  const std::string twice =
      "v 0 0 0\nv 1 0 0\nv 0 1 0\nv 0 0 1\nv 0 0 0\nv 1 0 0\nf 1 3 2\nf 5 2 4\nf 1 4 3\nf 6 3 4\n";
  EXPECT_NE(errors_for("twice.obj", twice).find("2 repeated"), std::string::npos);
  errors_for("tiny.obj", "v 0 0 0\nv 1e-6 0 0\nv 0 1e-6 0\nv 0 0 1e-6\nf 1 3 2\nf 1 2 4\nf 1 4 3\nf 2 3 4\n");
}

TEST_F(FitShape, AReportThatCannotBeMadeIsRefusedBeforeTheWork) {
  const std::string mesh = folder_.write("egg.obj", testing::ellipsoid_obj(1.5, 1.1, 0.9, 15, 24));
  expect_refusal(folder_, kFitShape,
                 {mesh, "-o", (folder_ / "o.json").string(), "--report", mesh + "/report"}, "report");
}

TEST_F(FitShape, BadMeshesAreRefused) {
  const std::string vertices = testing::kTetrahedron.substr(0, testing::kTetrahedron.find('f'));
  expect_mesh_refused("cut.ply", testing::truncated_ply());
  expect_mesh_refused("index.obj", testing::kTetrahedron + "f 1 2 5\n");
  expect_mesh_refused("open.obj", vertices + "f 1 3 2\nf 1 2 4\nf 1 4 3\n");
  expect_mesh_refused("points.obj", vertices);
  expect_mesh_refused("nan.obj", "v nan 0 0\n" + testing::kTetrahedron);
  expect_mesh_refused("empty.stl", "");
  expect_mesh_refused("text.ply", "this is not a mesh\n");
  expect_mesh_refused("flat.obj", "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\nf 1 3 2\n");
}

TEST_F(FitShape, BadFilesAreRefused) {
  const std::string mesh = folder_.write("egg.obj", testing::ellipsoid_obj(1.5, 1.1, 0.9, 15, 24));
  std::filesystem::create_directory(folder_ / "folder");
  const auto refuse = [&](const std::string& input, const std::filesystem::path& output,
                          const std::string& culprit) {
    expect_refusal(folder_, kFitShape, {input, "-o", output.string(), "--spheres", "4"}, culprit);
  };
  refuse((folder_ / "absent.obj").string(), folder_ / "out.json", "absent.obj");
  refuse((folder_ / "folder").string(), folder_ / "out.json", "folder");
  refuse(mesh, folder_ / "absent" / "out.json", "out.json");
  refuse(mesh, folder_ / "folder", "folder");
  expect_refusal(folder_, kFitShape, {mesh, "-o", (folder_ / "o.json").string(), "--spheres", "0"},
                 "--spheres");
  expect_refusal(folder_, kFitShape, {mesh, "-o", (folder_ / "o.json").string(), "--optimizer", "magic"},
                 "--optimizer");
  expect_refusal(folder_, kFitShape,
                 {mesh, "-o", (folder_ / "o.json").string(), "--kernel", "wyvill", "--subtract", "0.2"},
                 "--subtract");
}

}  // namespace
}  // namespace astrolith
