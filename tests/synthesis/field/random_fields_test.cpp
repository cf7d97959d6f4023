// What holds for the field of every recipe.

#include "geometry/mesh_sink.h"
#include "geometry/mesh_topology.h"
#include "numerics/parallel_for.h"
#include "recipe/recipe_json.h"
#include "synthesis/field/field_mesh.h"
#include "tests/support/points.h"
#include "tests/support/test_size.h"
#include "tests/synthesis/random_recipes.h"

namespace astrolith {
namespace {

struct Proofs {
  int boxes = 0, signs = 0;
};

// Compares what a block says of its box and of the signs in it with F at points of the box, and F with that
// of a block about the point alone.
void check_box(const ImplicitField& field, const Box& box, CounterRandom& random, Proofs& proofs) {
  const FieldBlock around = field.gather(widened(box, box.extent().x)), block = field.gather(box);
  constexpr std::size_t kPoints = 60;
  std::vector<float> value(kPoints), restricted(kPoints);
  const auto [x, y, z] = testing::FloatPoints(random, box, kPoints);
  block.evaluate(x, y, z, value, kExactEverywhere);
  around.restricted_to(box).evaluate(x, y, z, restricted, kExactEverywhere);
  ASSERT_EQ(value, restricted);
  std::vector<std::int8_t> sign(kPoints);
  block.find_signs(x, y, z, static_cast<float>(0.03 * box.extent().x), sign);
  const BlockContent content = block.content();
  proofs.boxes += content != BlockContent::kMixed;
  for (std::size_t i = 0; i < kPoints; ++i) {
    if (i % 12 == 0) {
      ASSERT_EQ(double{value[i]}, field.value({x[i], y[i], z[i]}));
    }
    if (content != BlockContent::kMixed) {
      ASSERT_EQ(value[i] > 0.0f, content == BlockContent::kInside);
    }
    if (sign[i] == 0) continue;
    ++proofs.signs;
    ASSERT_EQ(sign[i] > 0, value[i] > 0.0f) << value[i];
  }
}

TEST(RandomFields, BoxesAndSignsAreNeverWrongAndBitsAreThoseOfPoints) {
  Proofs proofs;
  for (std::uint64_t seed = 1; seed <= testing::by_size(4u, 80u) * testing::kLayerKinds; ++seed) {
    SCOPED_TRACE(seed);
    const ImplicitField field(testing::wild_recipe(seed));
    if (field.bounds().empty()) continue;
    CounterRandom random(seed, 4);
    for (int b = 0; b < 40; ++b) {
      const Vec3d corner = testing::random_point(random, field.bounds());
      const double size = std::pow(10.0, random.uniform(-3.0, -0.7));
      check_box(field, {corner, corner + Vec3d{size, size, size}}, random, proofs);
      if (HasFatalFailure()) return;
    }
  }
  EXPECT_GT(proofs.boxes, 900);
  EXPECT_GT(proofs.signs, 3000);
}

TEST(RandomFields, BecomeClosedManifoldsOfTheSameBytesForAnyThreads) {
  int made = 0;
  for (std::uint64_t seed = 1; seed <= testing::by_size(3u, 80u) * testing::kLayerKinds; ++seed) {
    SCOPED_TRACE(seed);
    const Recipe recipe = testing::wild_recipe(seed);
    validate_recipe(recipe, "random");
    std::vector<TriangleMesh> meshes;
    for (const int threads : {1, 3}) {
      const ThreadLimit limit(threads);
      const ImplicitField field(recipe);
      MeshCollector collector;
      if (!field.bounds().empty()) {
        mesh_field(field, field.bounds(), 12 + static_cast<int>(seed % 9) * 3, collector);
      }
      meshes.push_back(std::move(collector.mesh));
    }
    ASSERT_TRUE(meshes[0].vertices == meshes[1].vertices && meshes[0].triangles == meshes[1].triangles);
    if (meshes[0].triangles.empty()) continue;  // a difference may leave nothing
    const MeshTopology topology = analyze_topology(meshes[0]);
    ASSERT_TRUE(topology.closed && topology.manifold && topology.oriented);
    ++made;
  }
  EXPECT_GT(made, 25);
}

}  // namespace
}  // namespace astrolith
