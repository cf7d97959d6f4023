#include <cmath>

#include "numerics/hash_random.h"
#include "synthesis/body/level_expansion.h"
#include "synthesis/body/metaball_body.h"
#include "synthesis/body/surface_projection.h"
#include "tests/support/points.h"
#include "tests/synthesis/bodies.h"
#include "tests/synthesis/point_value.h"

namespace astrolith {
namespace {

using testing::evaluate_one;
using testing::PointValue;
using testing::potato_recipe;

TEST(MetaballBody, IsoValueOnlyScalesTheField) {
  // m >= T is the same body as m/T >= 1. For one kernel T = e^-c moves the surface to q = 1 + c/b.
  MetaballBody body = *testing::sphere_recipe(2.0).body;
  body.blend_exponent = 4.0;
  body.iso_value = std::exp(-3.0);
  const PointValue v = evaluate_one(prepare_metaballs(body), {4.0, 0.0, 0.0});
  EXPECT_NEAR(v.distance, 0.0f, 1e-5f);
  EXPECT_LT(v.gx, 0.0f);
}

// A potato. If dented, it has a third as many subtractive spheres as others.
MetaballBody potato(int num_spheres, std::uint64_t seed, double sharpness, bool dented) {
  MetaballBody body = *potato_recipe(num_spheres, seed, sharpness).body;
  CounterRandom random(seed, 1);
  if (dented) testing::add_dents(body, (num_spheres + 2) / 3, random);
  return body;
}

class Difference : public ::testing::TestWithParam<double> {};

TEST_P(Difference, IsWhatIsLeft) {
  MetaballBody body;
  body.blend_exponent = GetParam();
  body.iso_value = 0.7;
  body.spheres = {{{0, 0, 0}, 1.0}};
  body.subtract = {{{1.4, 0, 0}, 0.8}};
  const PreparedMetaballs metaballs = prepare_metaballs(body);
  const auto power = [&](const Sphere& s, const Vec3d& p) {
    return std::exp(body.blend_exponent * (1.0 - squared_norm(p - s.center) / (s.radius * s.radius)));
  };
  for (const double angle : {0.0, 0.4, 0.9, 1.5, 3.0}) {
    // Finds the point with sum f^m - sum g^m = T^m on a ray from the middle.
    const Vec3d ray{std::cos(angle), std::sin(angle), 0.0};
    double low = 0.0, high = 1.5;
    for (int i = 0; i < 60; ++i) {
      const double r = 0.5 * (low + high);
      const double rest = power(body.spheres[0], r * ray) - power(body.subtract[0], r * ray) -
                          std::pow(body.iso_value, body.blend_exponent);
      (rest > 0.0 ? low : high) = r;
    }
    EXPECT_NEAR(evaluate_one(metaballs, low * ray).distance, 0.0f, 1e-5f) << angle;
    EXPECT_LT(evaluate_one(metaballs, 1.05 * low * ray).distance, 0.0f) << angle;
  }
  EXPECT_LT(evaluate_one(metaballs, {0.95, 0, 0}).distance, 0.0f) << "a dent";
  EXPECT_GT(evaluate_one(metaballs, {-1.0, 0, 0}).distance, 0.0f) << "and none on the other side";
}

// The last value is the sharpest blend that validation accepts.
INSTANTIATE_TEST_SUITE_P(Sharpness, Difference,
                         ::testing::Values(0.5, 3.0, 12.0, 60.0 / (1.0 - std::log(0.7))));

TEST(MetaballBody, SubtractiveSpheresOutOfReachChangeNoBit) {
  MetaballBody body = *potato_recipe(40, 2).body;
  const PreparedMetaballs without = prepare_metaballs(body);
  body.subtract = {{{50, 0, 0}, 1.0}};  // its support does not reach the potato
  const PreparedMetaballs with = prepare_metaballs(body);
  CounterRandom random(3);
  for (int i = 0; i < 500; ++i) {
    const double x = random.uniform(-0.8, 0.8), y = random.uniform(-0.5, 0.5), z = random.uniform(-0.5, 0.5);
    const PointValue a = evaluate_one(without, {x, y, z}), b = evaluate_one(with, {x, y, z});
    ASSERT_EQ(math::to_bits(a.distance), math::to_bits(b.distance));
    ASSERT_EQ(math::to_bits(a.gx), math::to_bits(b.gx));
  }
}

class DistanceGradient : public ::testing::TestWithParam<bool> {};

TEST_P(DistanceGradient, IsTheDerivativeOfTheDistance) {
  const PreparedMetaballs metaballs = prepare_metaballs(potato(60, 3, 3.0, GetParam()));
  CounterRandom random(5);
  for (int i = 0; i < 200; ++i) {
    const Vec3d p = testing::random_point(random, {{-0.6, -0.4, -0.4}, {0.6, 0.4, 0.4}});
    if (std::fabs(evaluate_one(metaballs, p).distance) > 0.05f) continue;
    const Vec3d expected = testing::measured_gradient(metaballs, p, 2e-3);
    const Vec3d actual = distance_gradient(metaballs, p);
    EXPECT_LT(norm(actual - expected), 0.02) << i;
    if (!GetParam() || std::fabs(evaluate_one(metaballs, p).distance) < 0.02f) {
      EXPECT_NEAR(norm(actual), 1.0, 0.5) << i;
    }
  }
}

INSTANTIATE_TEST_SUITE_P(Dented, DistanceGradient, ::testing::Bool());

TEST(MetaballBody, SpheresBeyondTheirSupportChangeNoBit) {
  MetaballBody body = potato(120, 9, 2.0, true);
  body.cutoff_radii = 2.0;
  const PreparedMetaballs all = prepare_metaballs(body);
  CounterRandom random(1);
  std::size_t dropped = 0;
  for (int k = 0; k < 200; ++k) {
    Box box;
    box.extend({random.uniform(-0.6, 0.6), random.uniform(-0.4, 0.4), random.uniform(-0.4, 0.4)});
    box.extend(box.min + Vec3d{0.05, 0.03, 0.02});
    const PreparedMetaballs reaching = metaballs_reaching(all, box);
    dropped += all.spheres.size() - reaching.spheres.size();
    for (int i = 0; i < 20; ++i) {
      const Vec3d p = testing::random_point(random, box);
      const PointValue a = evaluate_one(all, p), b = evaluate_one(reaching, p);
      ASSERT_EQ(math::to_bits(a.distance), math::to_bits(b.distance));
      ASSERT_EQ(math::to_bits(a.gx), math::to_bits(b.gx));
    }
  }
  EXPECT_GT(dropped, 5000u);
}

TEST(MetaballBody, SharpAndTinyBodiesStayFinite) {
  MetaballBody body;
  body.blend_exponent = 80.0;
  body.spheres = {{{0, 0, 0}, 1e-3}, {{0, 0, 0}, 1e-3}, {{2e-4, 0, 0}, 1e-3}};
  const PointValue v = evaluate_one(prepare_metaballs(body), {1e-4, 0, 0});
  EXPECT_TRUE(std::isfinite(v.distance));
  EXPECT_GT(v.distance, 0.0f);
  EXPECT_TRUE(std::isfinite(v.gx));
}

// What the float evaluation finds at a point: s and grad L, and from these L - log T and the projection.
struct FoundLevel {
  float distance;
  Vec3f gradient;
  double level;
  Vec3d projection;
};
FoundLevel level_at(const PreparedMetaballs& metaballs, const Vec3f& p) {
  float s = 0, gx = 0, gy = 0, gz = 0;
  evaluate_metaballs(metaballs, 1, &p.x, &p.y, &p.z, &s, &gx, &gy, &gz);
  const float floor = metaballs.parameters.gradient_floor;
  const double slope = norm(Vec3d{gx, gy, gz});
  const auto coordinate = [&](float at, float g) {
    const float far = 1e30f;
    return double{projected_coordinate(at, g, gradient_length(gx, gy, gz, floor), s, far)};
  };
  return {s,
          {gx, gy, gz},
          double{s} * std::sqrt(slope * slope + double{floor}),
          {coordinate(p.x, gx), coordinate(p.y, gy), coordinate(p.z, gz)}};
}

MetaballBody drawn_body(CounterRandom& random, int k) {
  MetaballBody body = *testing::potato_recipe(1 + k % 90, random.next(), random.uniform(0.3, 8.0)).body;
  body.cutoff_radii = random.uniform(1.5, 9.0);
  if (k % 3 == 0) testing::add_dents(body, 1 + k % 20, random);
  return body;
}

TEST(LevelExpansion, HoldsTheLevelTheGradientAndTheProjectionAtFloatPoints) {
  CounterRandom random(31);
  int expanded = 0, tight = 0, narrow = 0;
  for (int k = 0; k < 1500; ++k) {
    const PreparedMetaballs all = prepare_metaballs(drawn_body(random, k));
    const double size = std::pow(10.0, random.uniform(-4.0, -0.7));
    const Vec3d corner{random.uniform(-0.6, 0.6), random.uniform(-0.4, 0.4), random.uniform(-0.4, 0.4)};
    const Box box{corner, corner + Vec3d{size, size * random.uniform(), size * random.uniform()}};
    const PreparedMetaballs near = metaballs_reaching(all, box);
    const std::optional<LevelExpansion> e = expand_level(near, box);
    if (!e) continue;
    ++expanded;
    const double radius = 0.5 * norm(box.extent());
    tight += (e->below + e->above) * radius * radius < 0.1 * norm(e->gradient) * radius;
    const ExpansionBounds bounds = bound_expansion(*e, near.parameters, box);
    const double longest_step = random.uniform(0.01, 0.2);
    const Box projected = projected_box(*e, bounds, near.parameters, box, longest_step);
    narrow += norm(projected.extent()) < 1.5 * norm(box.extent());
    for (int i = 0; i < 50; ++i) {
      const auto at = [&](double low, double high) {
        return static_cast<float>(low + (high - low) * (i < 8 ? i % 2 : random.uniform()));
      };
      const Vec3f p{at(box.min.x, box.max.x), at(box.min.y, box.max.y), at(box.min.z, box.max.z)};
      const Vec3f d = p - e->center;
      const double squared = squared_norm(d), linear = double{e->level} + double{dot(e->gradient, d)};
      const FoundLevel found = level_at(near, p);
      ASSERT_GE(found.level, linear - double{e->below} * squared - double{e->slack}) << "body " << k;
      ASSERT_LE(found.level, linear + double{e->above} * squared + double{e->slack}) << "body " << k;
      const double turn = double{e->turn} * std::sqrt(squared) + double{e->turn_slack};
      ASSERT_LE(double{norm(found.gradient - e->gradient)}, turn) << "body " << k;
      if (std::fabs(double{found.distance}) > longest_step) continue;
      ASSERT_TRUE(boxes_touch(projected, {found.projection, found.projection})) << "body " << k;
    }
  }
  EXPECT_GT(expanded, 600);
  EXPECT_GT(tight, 975);
  EXPECT_GT(narrow, 295);
}

// One sphere: L is quadratic, so that the lower bound is exact.
TEST(LevelExpansion, OfOneSphereIsExact) {
  MetaballBody body;
  body.spheres = {{{0, 0, 0}, 2.0}};
  const PreparedMetaballs sphere = prepare_metaballs(body);
  const Box box{{1.5, 0.0, 0.0}, {2.5, 1.0, 1.0}};
  const std::optional<LevelExpansion> e = expand_level(sphere, box);
  ASSERT_TRUE(e);
  EXPECT_NEAR(e->below, body.b / 4.0, 2e-3 * body.b);
  EXPECT_NEAR(e->above, 0.0, 1e-4);
  EXPECT_LT(e->slack, 1e-3);
}

TEST(LevelExpansion, IsEmptyFarFromAllSpheresAndForOtherKernels) {
  MetaballBody body;
  body.spheres = {{{0, 0, 0}, 1.0}};
  EXPECT_FALSE(expand_level(prepare_metaballs(body), {{90, 0, 0}, {91, 1, 1}}));
  body.kernel = Kernel::kWyvill;
  EXPECT_FALSE(expand_level(prepare_metaballs(body), {{0.5, 0, 0}, {1, 0.5, 0.5}}));
}

}  // namespace
}  // namespace astrolith
