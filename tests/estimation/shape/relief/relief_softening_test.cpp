#include "estimation/shape/relief/relief_fit.h"

#include "synthesis/field/field_tables.h"
#include "synthesis/field/implicit_field.h"
#include "tests/synthesis/bodies.h"
#include "tests/synthesis/reliefs.h"

namespace astrolith {
namespace {

double height_over(const Recipe& recipe, const Vec3d& p) {
  const ImplicitField field(recipe);
  const ReliefNoise& noise = *field.tables().layers[0].noise.get_if<ReliefNoise>();
  return double{height_at(noise, field.tables().arrays, to_float(p))};
}

TEST(ReliefSoftening, TakesHeightsBackBelowThePointsAlone) {
  Recipe ball = testing::sphere_recipe(1.0);
  ball.layers = {testing::relief_layer(ball, 0.05, -0.1, 0.1, [](const Vec3d&) { return 0.04; })};
  const Vec3d here = normalized(Vec3d{1, 2, 3}), there = normalized(Vec3d{1, 2, -3});
  EXPECT_GT(halve_heights({1.04 * here}, ball), 16u);
  EXPECT_NEAR(height_over(ball, here), 0.02, 1e-5);
  EXPECT_NEAR(height_over(ball, there), 0.04, 1e-5);
  int rounds = 1;
  while (halve_heights({here}, ball) > 0) ASSERT_LT(++rounds, 20);
  EXPECT_NEAR(height_over(ball, here), 0.0, 1e-5);
}

TEST(ReliefSoftening, NeedsARelief) {
  Recipe ball = testing::sphere_recipe(1.0);
  EXPECT_EQ(halve_heights({{1, 0, 0}}, ball), 0u);
}

}  // namespace
}  // namespace astrolith
