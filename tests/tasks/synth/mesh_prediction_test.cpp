#include "tasks/synth/mesh_prediction.h"

#include "numerics/errors.h"
#include "recipe/recipe_json.h"
#include "synthesis/field/field_mesh.h"
#include "tests/synthesis/bodies.h"

namespace astrolith {
namespace {

constexpr int kThreads = 1;

const std::filesystem::path kRecipeFile = "recipe.json";

MeshPart make_part(const MeshSpec& spec, const Recipe& recipe) {
  return make_body_part(spec, recipe, kRecipeFile, false, {}, {});
}

MeshPrediction predicted(const Recipe& recipe, MeshSpec spec, const std::string& file = "mesh.ply") {
  const MeshJob mesh{.spec = std::move(spec), .sinks = {.file = file}};
  return predict_mesh(mesh, make_part(mesh.spec, recipe), {kThreads});
}
MeshPrediction predicted(const Recipe& recipe, int resolution) {
  return predicted(recipe, MeshSpec{.resolution = resolution});
}

MeshStatistics made(const Recipe& recipe, int resolution, MeshTile tile = {}) {
  const ImplicitField field(recipe);
  MeshDiscard sink;
  return mesh_field(field, field.bounds(), resolution, sink, {}, tile);
}

Recipe with_landforms() {
  return parse_recipe(R"({"format_version": 1, "length_unit": "m",
  "body": {"type": "metaballs", "spheres": [[0, 0, 0, 100], [100, 0, 0, 75]]},
  "layers": [{"type": "simplex", "amplitude": 4, "frequency": 0.02, "octaves": 4},
             {"type": "craters", "population": {"count": 60, "least_diameter": 10, "greatest_diameter": 60,
                                                "exponent": 2}},
             {"type": "boulders", "population": {"count": 80, "least_diameter": 8, "greatest_diameter": 25,
                                                 "exponent": 2}}]})",
                      "test");
}

Recipe hills() {
  Recipe recipe = testing::potato_recipe(20, 3);
  recipe.layers.push_back(testing::fractal_layer(0.04, 4.0, 6));
  return recipe;
}

Recipe impulses() {
  Recipe recipe = testing::potato_recipe(20, 3);
  recipe.layers.push_back(testing::gabor_layer(0.004, 0.002));
  return recipe;
}

std::vector<Recipe> recipes() {
  return {testing::potato_recipe(20, 3), hills(), with_landforms(), impulses()};
}

// Samples are counted, because seconds depend on what else the machine does.
TEST(MeshPrediction, TrianglesAreNearThoseOfTheMeshFromFewOfItsSamples) {
  for (const Recipe& recipe : recipes()) {
    for (const int resolution : {40, 100, 240}) {
      const MeshStatistics mesh = made(recipe, resolution);
      const MeshPrediction prediction = predicted(recipe, resolution);
      EXPECT_EQ(prediction.resolution, resolution);
      EXPECT_NEAR(prediction.triangles / double(mesh.triangles), 1.0, 0.15) << resolution;
      EXPECT_NEAR(prediction.file_bytes / (25.0 * double(mesh.triangles)), 1.0, 0.15) << resolution;
      EXPECT_GT(prediction.own_evaluations, 0.0);
      if (resolution < 240) continue;
      EXPECT_LE(prediction.own_evaluations, 0.15 * double(mesh.evaluations));
    }
  }
}

TEST(MeshPrediction, ASmallMeshIsExact) {
  const Recipe recipe = hills();
  EXPECT_EQ(predicted(recipe, 60).triangles, double(made(recipe, 60).triangles));
}

TEST(MeshPrediction, ATileIsPredictedAlone) {
  const Recipe recipe = testing::potato_recipe(20, 3);
  const MeshTile tile{1, 3};
  const auto predicted_tile = [&](int cells) {
    return predicted(recipe, MeshSpec{.tile = "2/3", .resolution = cells}).triangles;
  };
  EXPECT_EQ(predicted_tile(64), double(made(recipe, 64, tile).triangles));
  EXPECT_NEAR(predicted_tile(200) / double(made(recipe, 200, tile).triangles), 1.0, 0.2);
}

// Small meshes are counted a few times. Their probes would take many times what the mesh takes, since each is
// as wide as heights are high.
TEST(MeshPrediction, TrianglesChooseTheResolution) {
  const MeshSpec whole;
  for (const Recipe& recipe : recipes()) {
    for (const double triangles : {5e3, 2e4, 1e5}) {
      MeshEstimator estimator(make_part(whole, recipe));
      const int resolution = estimator.resolution_for(triangles);
      const MeshStatistics mesh = made(recipe, resolution);
      EXPECT_NEAR(double(mesh.triangles), triangles, 0.055 * triangles);
      if (triangles > 2e4) continue;
      const MeshEstimate estimate = estimator.at(resolution);
      EXPECT_NEAR(estimate.triangles, double(mesh.triangles), 0.05 * double(mesh.triangles));
      if (triangles < 2e4) continue;
      EXPECT_LE(estimate.own_evaluations, 4.0 * double(mesh.evaluations));
    }
  }
}

TEST(MeshPrediction, MoreTrianglesThanTheFinestMeshHasAreRefused) {
  const Recipe recipe = testing::potato_recipe(20, 3);
  const MeshSpec whole;
  EXPECT_THROW(MeshEstimator(make_part(whole, recipe)).resolution_for(1e10), InputError);
}

TEST(MeshPrediction, UsesOfTheMeshAddToIt) {
  const Recipe recipe = hills();
  Recipe eroded = recipe;
  eroded.erosion = Erosion{.talus_angle = 30.0};
  constexpr int kFine = 8192;  // so that its bytes are far more than this process has taken before
  const MeshPrediction plain = predicted(recipe, kFine);
  const MeshPrediction labels = predicted(recipe, MeshSpec{.resolution = kFine, .labels = true}),
                       gravity = predicted(recipe, MeshSpec{.resolution = kFine, .gravity = {2000, 6}}),
                       even = predicted(recipe, MeshSpec{.resolution = kFine, .even = true}),
                       erosion = predicted(eroded, kFine);
  EXPECT_NEAR(labels.file_bytes / plain.file_bytes, 29.0 / 25.0, 0.01);
  EXPECT_NEAR(gravity.file_bytes / plain.file_bytes, 41.0 / 25.0, 0.01);
  EXPECT_GT(gravity.processor_seconds, 1.3 * plain.processor_seconds);
  EXPECT_GT(erosion.processor_seconds, plain.processor_seconds);
  // Bytes for each triangle that is held in memory.
  const auto more = [&](const MeshPrediction& use) {
    return (use.peak_bytes - plain.peak_bytes) / plain.triangles;
  };
  EXPECT_GT(more(even), 40.0);
  EXPECT_GT(more(erosion), 90.0);
  EXPECT_GT(more(gravity), 200.0);
  EXPECT_GT(more(predicted(recipe, MeshSpec{.resolution = kFine}, "mesh.stl")), 30.0);
}

// Impulses are kept in bricks, of which a finer mesh needs no more.
TEST(MeshPrediction, ImpulsesTakeMemory) {
  constexpr int kFine = 4096;  // so that its bytes are more than this process has taken before
  Recipe recipe = impulses();
  const double fine = predicted(recipe, kFine).peak_bytes;
  std::get<GaborLayer>(recipe.layers.front()).pixel_size = 0.016;
  EXPECT_GT(fine, predicted(recipe, kFine).peak_bytes + 1e6);
}

TEST(MeshPrediction, MemoryThatIsNotThereIsRefused) {
  const Recipe recipe = hills();
  const MeshJob planned{.sinks = {.file = "mesh.obj"}};
  const MeshPrediction mesh = predict_mesh(planned, make_part(planned.spec, recipe), {kThreads});
  EXPECT_NO_THROW(require_memory(planned, recipe, mesh, 1.01 * mesh.peak_bytes));
  EXPECT_THROW(require_memory(planned, recipe, mesh, 0.99 * mesh.peak_bytes), InputError);
}

}  // namespace
}  // namespace astrolith
