#include "synthesis/exemplar/exemplar_ground.h"

#include "synthesis/field/field_at_point.h"
#include "synthesis/field/field_model_internal.h"
#include "synthesis/field/implicit_field.h"
#include "tests/synthesis/bodies.h"
#include "tests/synthesis/exemplars.h"

namespace astrolith {
namespace {

using testing::exemplar_layer;
using testing::fractal_layer;
using testing::sphere_recipe;

// The slope of a plane field is found exactly, and noise of a single sample is spread over all.
TEST(LayeredGround, FindsTheSlopeOfAPlane) {
  const Vec3f slope{0.3f, -0.7f, 0.0f};
  const FieldBelow below = [&](int n, const float* x, const float* y, const float* z, float* field) {
    for (int i = 0; i < n; ++i) field[i] = slope.x * x[i] + slope.y * y[i] - z[i] + 5.0f;
  };
  const BodyTables none{};
  const BodyGround body{none, {}, {}};
  const ExemplarGround ground{body, below, 10.0};
  const Vec3f inward = layered_inward(ground, {0.1f, 0.2f, 0.0f}, {0.0f, 0.0f, -2.0f}, 0.5f);
  EXPECT_NEAR(inward.x, slope.x, 1e-5f);
  EXPECT_NEAR(inward.y, slope.y, 1e-5f);
  EXPECT_NEAR(inward.z, -1.0f, 1e-5f);
}

TEST(LayeredGround, TurnsAFrameByTheLeastAngle) {
  const TangentFrame bare = tangent_frame({0.2f, -0.3f, -1.0f});
  const TangentFrame turned = turned_frame(bare, {0.9f, 0.4f, -0.6f});
  EXPECT_NEAR(dot(turned.u, turned.u), 1.0f, 1e-5f);
  EXPECT_NEAR(dot(turned.v, turned.v), 1.0f, 1e-5f);
  EXPECT_NEAR(dot(turned.u, turned.v), 0.0f, 1e-5f);
  EXPECT_NEAR(dot(turned.u, turned.n), 0.0f, 1e-5f);
  // The axis of the turn stays where it is in both frames.
  const Vec3f axis = cross(bare.n, turned.n);
  EXPECT_NEAR(dot(axis, bare.u), dot(axis, turned.u), 1e-5f);
  EXPECT_NEAR(dot(axis, bare.v), dot(axis, turned.v), 1e-5f);
  const TangentFrame same = turned_frame(bare, -bare.n);
  EXPECT_NEAR(dot(same.u, bare.u), 1.0f, 1e-6f);
}

// A ball whose dips are as steep as 40 degrees and larger than the image, with and without stones.
struct Dips {
  ImplicitField bare{make_recipe(false)}, stones{make_recipe(true)};

  static Recipe make_recipe(bool with_stones) {
    Recipe recipe = sphere_recipe(1.0);
    FractalLayer dips = fractal_layer(0.06, 2.0, 1);
    dips.seed = 5;  // keeps its shape whatever stands below it
    recipe.layers = {dips};
    if (with_stones) recipe.layers.push_back(exemplar_layer(0.002, 0.002));
    return recipe;
  }
  // The point of the layered ball over a direction, and the height of the stones there.
  Vec3d point(const Vec3d& direction) const {
    Vec3d p = normalized(direction);
    for (int step = 0; step < 12; ++step) p = p + bare.value(p) * normalized(direction);
    return p;
  }
  double height(const Vec3d& p) const { return stones.value(p) - bare.value(p); }
};

// Mean squares of the differences of heights per arc length, down the slope and across it, where it is steep.
// With frames of the bare surface the ratio is .66: stones are stretched down the slope.
TEST(LayeredGround, DoesNotSquashStonesInSteepDips) {
  const Dips ball;
  CounterRandom random(23);
  double down = 0.0, across = 0.0;
  int steep = 0;
  for (int i = 0; i < 30000 && steep < 1500; ++i) {
    const Vec3d n = normalized(Vec3d{random.normal(), random.normal(), random.normal()});
    const Vec3d side = normalized(cross(n, Vec3d{random.normal(), random.normal(), random.normal()}));
    const Vec3d p = ball.point(n);
    const auto rise = [&](const Vec3d& t) {
      return (norm(ball.point(n + 0.01 * t)) - norm(p)) / (0.01 * norm(p));
    };
    const Vec3d other = cross(n, side);
    const double rise_side = rise(side), rise_other = rise(other), slope = std::hypot(rise_side, rise_other);
    if (slope < 0.6) continue;
    ++steep;
    const Vec3d downhill = (rise_side / slope) * side + (rise_other / slope) * other;
    const auto roughness = [&](const Vec3d& t) {
      const Vec3d q = ball.point(n + 0.002 * t);
      return std::pow((ball.height(q) - ball.height(p)) / norm(q - p), 2);
    };
    down += roughness(downhill);
    across += roughness(cross(n, downhill));
  }
  ASSERT_GT(steep, 500);
  EXPECT_GT(down / across, 0.85);
  EXPECT_LT(down / across, 1.15);
}

// The exemplar of a patch stands on the same ground as that of the whole body.
TEST(LayeredGround, IsTheSameInAPatch) {
  Recipe recipe = Dips::make_recipe(true);
  const Vec3d center = Dips().point({1.0, 0.3, -0.2});
  const ImplicitField whole(recipe), patch(recipe, "r", PatchCube{center, 0.05});
  const FieldBlock block = patch.gather({center - Vec3d{0.04, 0.04, 0.04}, center + Vec3d{0.04, 0.04, 0.04}});
  CounterRandom random(29);
  std::vector<float> x(300), y(300), z(300), value(300);
  for (std::size_t i = 0; i < x.size(); ++i) {
    x[i] = static_cast<float>(random.uniform(-0.02, 0.02));
    y[i] = static_cast<float>(random.uniform(-0.02, 0.02));
    z[i] = static_cast<float>(random.uniform(-0.02, 0.02));
  }
  block.evaluate_local(center, x, y, z, value, kExactEverywhere);
  for (std::size_t i = 0; i < x.size(); ++i) {
    const Vec3d p{center.x + double{x[i]}, center.y + double{y[i]}, center.z + double{z[i]}};
    EXPECT_NEAR(value[i], whole.value(p), 2e-5) << i;
  }
}

}  // namespace
}  // namespace astrolith
