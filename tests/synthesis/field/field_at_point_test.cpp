// A point evaluated by itself (field_at_point.h) has the bits of many points evaluated together.
#include "synthesis/field/field_at_point.h"

#include <algorithm>
#include <variant>
#include <vector>

#include "synthesis/field/implicit_field.h"
#include "synthesis/field/patch_place.h"
#include "tests/synthesis/block_lists.h"
#include "tests/synthesis/random_recipes.h"

namespace astrolith {
namespace {

Box box_about(const Vec3d& p, double half) {
  return {p - Vec3d{half, half, half}, p + Vec3d{half, half, half}};
}

// Compares points in blocks of several sizes, with the bands that meshes and normals use.
void expect_same_bits(const Recipe& recipe, std::uint64_t seed) {
  const ImplicitField field(recipe);
  const FieldView& tables = field.tables();
  CounterRandom random(seed, 1);
  const Box bounds = field.bounds();
  if (bounds.empty()) return;
  for (int b = 0; b < 3; ++b) {
    const Vec3d center{random.uniform(bounds.min.x, bounds.max.x), random.uniform(bounds.min.y, bounds.max.y),
                       random.uniform(bounds.min.z, bounds.max.z)};
    const double half = b < 2 ? 0.03 : 0.15;
    const FieldBlock block = field.gather(box_about(center, half));
    BlockListStore blocks(tables);
    blocks.add(tables, box_about(center, 0.01));  // a block before the tested one
    blocks.add(tables, block.box());
    std::vector<float> x(60), y(60), z(60), value(60);
    for (std::size_t i = 0; i < x.size(); ++i) {
      x[i] = static_cast<float>(center.x + 0.99 * random.uniform(-half, half));
      y[i] = static_cast<float>(center.y + 0.99 * random.uniform(-half, half));
      z[i] = static_cast<float>(center.z + 0.99 * random.uniform(-half, half));
    }
    std::vector<float> corners(x.size());
    block.evaluate_tetrahedra(x, y, z, corners);
    for (std::size_t i = 0; i < x.size(); i += 4) {
      const Vec3f p[] = {{x[i], y[i], z[i]},
                         {x[i + 1], y[i + 1], z[i + 1]},
                         {x[i + 2], y[i + 2], z[i + 2]},
                         {x[i + 3], y[i + 3], z[i + 3]}};
      float four[4];
      field_at_tetrahedron(tables, blocks.view().block(1), p, four);
      for (std::size_t k = 0; k < 4; ++k) {
        ASSERT_EQ(math::to_bits(four[k]), math::to_bits(corners[i + k])) << seed;
      }
    }
    for (const float band : {kExactEverywhere, 0.02f, 0.0f}) {
      block.evaluate(x, y, z, value, band);
      for (std::size_t i = 0; i < x.size(); ++i) {
        const float one = field_at(tables, blocks.view().block(1), {x[i], y[i], z[i]}, band);
        ASSERT_EQ(math::to_bits(one), math::to_bits(value[i])) << seed << " " << one << " " << value[i];
      }
    }
  }
}

TEST(FieldAtPoint, HasTheBitsOfTheField) {
  for (std::uint64_t seed = 1; seed <= 3 * testing::kLayerKinds; ++seed) {
    expect_same_bits(testing::wild_recipe(seed), seed);
  }
}

// Expects field_at() to have the bits of a block at points of patches, too, of bodies at the origin and of
// bodies so far from it that float coordinates of their frames hold no fine layer.
void expect_same_bits_in_patch(const Recipe& recipe, std::uint64_t seed, double far) {
  Recipe moved = recipe;
  for (Sphere& s : moved.body->spheres) s.center.x += far;
  for (Sphere& s : moved.body->subtract) s.center.x += far;
  const ImplicitField whole(moved);
  const Box bounds = whole.bounds();
  if (bounds.empty()) return;
  CounterRandom random(seed, 4);
  const Vec3d center{random.uniform(bounds.min.x, bounds.max.x), random.uniform(bounds.min.y, bounds.max.y),
                     random.uniform(bounds.min.z, bounds.max.z)};
  const double half = 0.03;
  const ImplicitField field(moved, "recipe", PatchCube{center, 2.0 * half});
  const FieldView& tables = field.patch_tables();
  const FieldBlock block = field.gather(PatchPlace(center).in_body(box_about({}, half)));
  BlockListStore blocks(tables);
  blocks.add(tables, block.box());
  std::vector<float> x(60), y(60), z(60), value(60);
  for (auto* c : {&x, &y, &z}) {
    for (float& v : *c) v = static_cast<float>(0.99 * random.uniform(-half, half));
  }
  const auto point = [&](std::size_t i) { return Vec3f{x[i], y[i], z[i]}; };
  block.evaluate_local_tetrahedra(center, x, y, z, value);
  for (std::size_t i = 0; i < x.size(); i += 4) {
    const Vec3f p[] = {point(i), point(i + 1), point(i + 2), point(i + 3)};
    float four[4];
    field_at_tetrahedron<Frame::kPatch>(tables, blocks.view().block(0), p, four);
    for (std::size_t k = 0; k < 4; ++k) {
      ASSERT_EQ(math::to_bits(four[k]), math::to_bits(value[i + k])) << seed;
    }
  }
  for (const float band : {kExactEverywhere, 0.02f, 0.0f}) {
    block.evaluate_local(center, x, y, z, value, band);
    for (std::size_t i = 0; i < x.size(); ++i) {
      const float one = field_at<Frame::kPatch>(tables, blocks.view().block(0), point(i), band);
      ASSERT_EQ(math::to_bits(one), math::to_bits(value[i])) << seed << " " << one << " " << value[i];
    }
  }
}

TEST(FieldAtPoint, HasTheBitsOfThePatch) {
  for (std::uint64_t seed = 1; seed <= 2 * testing::kLayerKinds; ++seed) {
    const Recipe recipe = testing::wild_recipe(seed);
    expect_same_bits_in_patch(recipe, seed, 0.0);
    // Landforms have no place on a body so far from the origin.
    const bool landforms = std::any_of(recipe.layers.begin(), recipe.layers.end(), [](const Layer& layer) {
      return std::holds_alternative<CraterLayer>(layer) || std::holds_alternative<BoulderLayer>(layer);
    });
    if (!landforms) expect_same_bits_in_patch(recipe, seed, 3000.0);
  }
}

}  // namespace
}  // namespace astrolith
