// Plain arrays give the bits of the field that they were made from.
#include "synthesis/field/flat_value.h"

#include <vector>

#include "synthesis/field/flat_blocks_data.h"
#include "tests/synthesis/random_recipes.h"

namespace astrolith {
namespace {

using testing::potato_recipe;

Box widened(const Vec3d& p, double half) {
  return {p - Vec3d{half, half, half}, p + Vec3d{half, half, half}};
}

// Blocks of all sizes, and the bands of meshes and of normals.
void expect_same_bits(const Recipe& recipe, std::uint64_t seed) {
  const ImplicitField field(recipe);
  ASSERT_EQ(obstacle_to_flattening(field, 0.1), "");
  const FlatFieldData data(field);
  const FlatField flat = data.view();
  CounterRandom random(seed, 1);
  const Box bounds = field.bounds();
  for (int b = 0; b < 4; ++b) {
    const Vec3d center{random.uniform(bounds.min.x, bounds.max.x), random.uniform(bounds.min.y, bounds.max.y),
                       random.uniform(bounds.min.z, bounds.max.z)};
    const double half = b < 3 ? 0.03 : 0.15;
    const FieldBlock block = field.gather(widened(center, half));
    FlatBlocksData blocks(data);
    blocks.add(field.gather(widened(center, 0.01)));  // another one before it
    blocks.add(block);
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
      flat_tetrahedron(flat, blocks.view().block(1), p, four);
      for (std::size_t k = 0; k < 4; ++k) {
        ASSERT_EQ(math::bits_of(four[k]), math::bits_of(corners[i + k])) << seed;
      }
    }
    for (const float band : {kExactEverywhere, 0.02f, 0.0f}) {
      block.evaluate(x, y, z, value, band);
      for (std::size_t i = 0; i < x.size(); ++i) {
        const float one = flat_value(flat, blocks.view().block(1), {x[i], y[i], z[i]}, band);
        ASSERT_EQ(math::bits_of(one), math::bits_of(value[i])) << seed << " " << one << " " << value[i];
      }
    }
  }
}

TEST(FlatField, HasTheBitsOfTheField) {
  for (std::uint64_t seed = 1; seed <= 16; ++seed) expect_same_bits(testing::random_recipe(seed), seed);
}

TEST(FlatField, NamesWhatItLacks) {
  Recipe recipe = potato_recipe(20, 1);
  recipe.layers = {testing::gabor_layer(0.01, 0.01)};
  const ImplicitField field(recipe);
  EXPECT_EQ(obstacle_to_flattening(field, 0.05), "");
  EXPECT_NE(obstacle_to_flattening(field, 2.0), "");
  SpotLayer fine;
  fine.amplitude = 0.001;
  fine.size = 0.005;
  fine.cell_size = 0.01;
  recipe.layers = {fine};
  const ImplicitField pitted(recipe);
  EXPECT_EQ(obstacle_to_flattening(pitted, 0.05), "");
  EXPECT_NE(obstacle_to_flattening(pitted, 2.0), "");
}

}  // namespace
}  // namespace astrolith
