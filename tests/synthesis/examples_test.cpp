// Every example recipe has a description and becomes a closed manifold at any resolution.
#include <filesystem>

#include "geometry/mesh_topology.h"
#include "recipe/recipe_json.h"
#include "synthesis/field/field_mesh.h"
#include "synthesis/field/implicit_field.h"
#include "tests/support/test_size.h"

namespace astrolith {
namespace {

TEST(Examples, BecomeClosedManifolds) {
  const std::vector resolutions = testing::by_size(std::vector{17, 40}, std::vector{64, 128, 256});
  int examples = 0;
  for (const auto& entry : std::filesystem::directory_iterator(ASTROLITH_EXAMPLES)) {
    SCOPED_TRACE(entry.path().filename());
    const Recipe recipe = read_recipe(entry.path());
    EXPECT_FALSE(recipe.description.empty());
    EXPECT_EQ(recipe_to_json(parse_recipe(recipe_to_json(recipe), "r")), recipe_to_json(recipe));
    const ImplicitField field(recipe);
    for (const int resolution : resolutions) {
      MeshCollector collector;
      mesh_field(field, field.bounds(), resolution, collector);
      const MeshTopology topology = analyze_topology(collector.mesh);
      EXPECT_TRUE(topology.closed && topology.manifold && topology.oriented);
      EXPECT_GT(collector.mesh.triangles.size(), 100u);
      RecordProperty(
          entry.path().stem().string() + "_" + std::to_string(resolution),
          "genus " + std::to_string(topology.genus) + ", components " + std::to_string(topology.components));
    }
    ++examples;
  }
  EXPECT_GE(examples, 5);
}

}  // namespace
}  // namespace astrolith
