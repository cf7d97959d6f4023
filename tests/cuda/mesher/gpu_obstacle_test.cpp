#include "cuda/mesher/gpu_mesher.h"

#include "synthesis/field/implicit_field.h"
#include "tests/synthesis/bodies.h"

namespace astrolith {
namespace {

TEST(GpuObstacle, NamesWhatAFieldLacks) {
  Recipe recipe = testing::potato_recipe(20, 1);
  recipe.layers = {testing::gabor_layer(0.01, 0.01)};
  const ImplicitField field(recipe);
  EXPECT_EQ(obstacle_on_gpu(field.tables(), 0.05), "");
  EXPECT_NE(obstacle_on_gpu(field.tables(), 4.0), "");
  SpotLayer fine;
  fine.amplitude = 0.001;
  fine.size = 0.005;
  fine.cell_size = 0.01;
  recipe.layers = {fine};
  const ImplicitField pitted(recipe);
  EXPECT_EQ(obstacle_on_gpu(pitted.tables(), 0.05), "");
  EXPECT_NE(obstacle_on_gpu(pitted.tables(), 4.0), "");
  FractalLayer warp;  // moves the points at which the spots are evaluated
  warp.amplitude = 0.5;
  warp.use.combination.kind = Combine::kWarp;
  warp.use.combination.direction = {1, 1, 1};
  recipe.layers = {warp, fine};
  EXPECT_NE(obstacle_on_gpu(ImplicitField(recipe).tables(), 0.05), "");
}

}  // namespace
}  // namespace astrolith
