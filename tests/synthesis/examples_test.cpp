// Every example recipe says what it shows and becomes a closed manifold at any resolution.
#include <filesystem>

#include "geometry/mesh_topology.h"
#include "recipe/recipe_json.h"
#include "synthesis/implicit_field.h"
#include "synthesis/mesher.h"

namespace astrolith {
namespace {

TEST(Examples, BecomeClosedManifolds) {
  int examples = 0;
  for (const auto& entry : std::filesystem::directory_iterator(ASTROLITH_EXAMPLES)) {
    SCOPED_TRACE(entry.path().filename());
    const Recipe recipe = read_recipe(entry.path());
    EXPECT_FALSE(recipe.description.empty());
    EXPECT_EQ(recipe_to_json(parse_recipe(recipe_to_json(recipe), "r")), recipe_to_json(recipe));
    const ImplicitField field(recipe);
    for (const int resolution : {17, 40, 71}) {
      MeshCollector collector;
      mesh_field(field, field.bounds(), resolution, collector);
      const MeshTopology topology = analyze_topology(collector.mesh);
      EXPECT_TRUE(topology.closed && topology.manifold && topology.oriented);
      EXPECT_GT(collector.mesh.triangles.size(), 300u);
    }
    ++examples;
  }
  EXPECT_GE(examples, 5);
}

}  // namespace
}  // namespace astrolith
