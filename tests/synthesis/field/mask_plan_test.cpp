#include "synthesis/field/mask_plan.h"

#include "synthesis/field/field_tables.h"
#include "synthesis/field/implicit_field.h"
#include "tests/synthesis/bodies.h"

namespace astrolith {
namespace {

FractalLayer named(const std::string& name, const std::string& mask = "") {
  FractalLayer layer = testing::fractal_layer(0.01, 5.0, 1);
  layer.name = name;
  if (!mask.empty()) layer.use.mask = LayerMask{mask, -0.01, 0.01};
  return layer;
}

TEST(MaskPlan, NamesTheLastLayerBeforeAMask) {
  const std::vector<Layer> layers{named("a"), named("a"),      named("b", "a"),
                                  named("a"), named("c", "a"), named("d", "b")};
  const MaskPlan plan = plan_masks(layers);
  EXPECT_EQ(plan.masking, (std::vector<int>{-1, -1, 1, -1, 3, 2}));
  EXPECT_EQ(plan.last_use, (std::vector<int>{-1, 2, 5, 4, -1, -1}));
}

// A slot that a layer reads is not overwritten by the same layer, and is free for the next one.
TEST(MaskPlan, SlotsAreUsedAgain) {
  MaskSlots slots;
  EXPECT_EQ(slots.take(0, 1), 0);
  EXPECT_EQ(slots.take(1, 2), 1);
  EXPECT_EQ(slots.take(2, 5), 0);
  EXPECT_EQ(slots.take(3, 4), 1);
  EXPECT_EQ(slots.take(4, 5), 2);
  EXPECT_EQ(slots.count(), 3);
}

// Each of many layers masks the next: their heights take two slots, not one for each layer.
TEST(MaskPlan, AChainOfMasksKeepsTwoHeights) {
  Recipe recipe = testing::sphere_recipe(1.0);
  recipe.layers = {named("0")};
  for (int i = 1; i < 60; ++i) recipe.layers.push_back(named(std::to_string(i), std::to_string(i - 1)));
  EXPECT_EQ(ImplicitField(recipe).tables().num_kept_heights, 2u);
}

}  // namespace
}  // namespace astrolith
