#include "synthesis/mesh/mesh_prediction.h"

#include "synthesis/field/field_mesh.h"
#include "synthesis/field/implicit_field.h"
#include "tests/synthesis/bodies.h"

namespace astrolith {
namespace {

MeshStatistics statistics_at(const ImplicitField& field, int resolution) {
  MeshCollector sink;
  return mesh_field(field, field.bounds(), resolution, sink);
}

MeshGrowth growth_of(const ImplicitField& field) {
  return MeshGrowth([&](int resolution) { return statistics_at(field, resolution); });
}

TEST(MeshPrediction, MeetsTheMeshOfASmoothBody) {
  const ImplicitField field(testing::potato_recipe(20, 3));
  const MeshGrowth growth = growth_of(field);
  for (const int resolution : {150, 300}) {
    const MeshStatistics made = statistics_at(field, resolution);
    const MeshPrediction predicted = growth.at(resolution);
    EXPECT_NEAR(predicted.triangles / static_cast<double>(made.triangles), 1.0, 0.03);
    EXPECT_NEAR(predicted.evaluations / static_cast<double>(made.evaluations), 1.0, 0.2);
    EXPECT_NEAR(predicted.working_bytes / static_cast<double>(made.working_bytes), 1.0, 0.5);
  }
}

TEST(MeshPrediction, ChoosesTheResolutionOfATriangleCount) {
  const ImplicitField field(testing::potato_recipe(20, 3));
  const MeshGrowth growth = growth_of(field);
  const int resolution = growth.resolution_for(200e3);
  EXPECT_NEAR(static_cast<double>(statistics_at(field, resolution).triangles), 200e3, 6e3);
  EXPECT_EQ(growth.resolution_for(1e15), kMaxResolution);
  EXPECT_LT(growth.resolution_for(100.0), 20);
}

TEST(MeshPrediction, NothingToContinueIsAnError) {
  Recipe recipe = testing::potato_recipe(1, 3);
  recipe.body->iso_value = 1e6;  // no point of the body reaches it
  EXPECT_ANY_THROW(growth_of(ImplicitField(recipe)).resolution_for(1000.0));
}

}  // namespace
}  // namespace astrolith
