#include "synthesis/body/metaball_body.h"

#include <array>

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
    ASSERT_EQ(math::bits_of(a.distance), math::bits_of(b.distance));
    ASSERT_EQ(math::bits_of(a.gx), math::bits_of(b.gx));
  }
}

class DistanceGradient : public ::testing::TestWithParam<bool> {};

TEST_P(DistanceGradient, IsTheDerivativeOfTheDistance) {
  const PreparedMetaballs metaballs = prepare_metaballs(potato(60, 3, 3.0, GetParam()));
  CounterRandom random(5);
  const double h = 2e-3;
  for (int i = 0; i < 200; ++i) {
    const Vec3d p{random.uniform(-0.6, 0.6), random.uniform(-0.4, 0.4), random.uniform(-0.4, 0.4)};
    if (std::fabs(evaluate_one(metaballs, p).distance) > 0.05f) continue;
    const auto slope = [&](const Vec3d& d) {
      return (static_cast<double>(evaluate_one(metaballs, p + d).distance) -
              static_cast<double>(evaluate_one(metaballs, p - d).distance)) /
             (2 * h);
    };
    const Vec3d expected{slope({h, 0, 0}), slope({0, h, 0}), slope({0, 0, h})};
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
      const Vec3d p{random.uniform(box.min.x, box.max.x), random.uniform(box.min.y, box.max.y),
                    random.uniform(box.min.z, box.max.z)};
      const PointValue a = evaluate_one(all, p), b = evaluate_one(reaching, p);
      ASSERT_EQ(math::bits_of(a.distance), math::bits_of(b.distance));
      ASSERT_EQ(math::bits_of(a.gx), math::bits_of(b.gx));
    }
  }
  EXPECT_GT(dropped, 5000u);
}

TEST(MetaballBody, ManyPointsGiveTheBitsOfOne) {
  const PreparedMetaballs metaballs = prepare_metaballs(potato(40, 2, 3.0, true));
  constexpr int n = 133;  // no multiple of any vector width
  std::array<float, n> x, y, z, s, gx, gy, gz;
  CounterRandom random(8);
  for (std::size_t i = 0; i < n; ++i) {
    x[i] = static_cast<float>(random.uniform(-0.6, 0.6));
    y[i] = static_cast<float>(random.uniform(-0.4, 0.4));
    z[i] = static_cast<float>(random.uniform(-0.4, 0.4));
  }
  evaluate_metaballs(metaballs, n, x.data(), y.data(), z.data(), s.data(), gx.data(), gy.data(), gz.data());
  for (std::size_t i = 0; i < n; ++i) {
    const PointValue one = evaluate_one(metaballs, {x[i], y[i], z[i]});
    ASSERT_EQ(math::bits_of(one.distance), math::bits_of(s[i]));
    ASSERT_EQ(math::bits_of(one.gz), math::bits_of(gz[i]));
  }
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

TEST(MetaballBody, IntervalsHoldEveryValue) {
  CounterRandom random(4);
  for (int k = 0; k < 3000; ++k) {
    MetaballBody body =
        potato(1 + k % 50, static_cast<std::uint64_t>(k), random.uniform(0.5, 10.0), k % 3 == 0);
    body.cutoff_radii = random.uniform(1.1, 5.0);
    const PreparedMetaballs metaballs = prepare_metaballs(body);
    Box box;
    box.extend({random.uniform(-0.8, 0.8), random.uniform(-0.6, 0.6), random.uniform(-0.6, 0.6)});
    const double size = std::pow(10.0, random.uniform(-3.0, -0.3));
    box.extend(box.min + Vec3d{size, size * random.uniform(), size * random.uniform()});
    const MetaballInterval bound = bound_metaballs(metaballs_reaching(metaballs, box), box);
    const double floor = metaballs.parameters.gradient_floor;
    for (int i = 0; i < 40; ++i) {
      const Vec3d p{random.uniform(box.min.x, box.max.x), random.uniform(box.min.y, box.max.y),
                    random.uniform(box.min.z, box.max.z)};
      const PointValue v = evaluate_one(metaballs, p);
      const double gradient =
          std::sqrt(double{v.gx} * v.gx + double{v.gy} * v.gy + double{v.gz} * v.gz + floor);
      const double level = double{v.distance} * gradient;
      ASSERT_LE(gradient, bound.gradient_max);
      ASSERT_GE(level, bound.level_min);
      ASSERT_LE(level, bound.level_max);
    }
  }
}

// At points of a box near the surface |grad L|, evaluated in double, keeps within its bounds.
TEST(MetaballBody, BoundsOfTheGradientHoldNearTheSurface) {
  CounterRandom random(12);
  int tighter = 0, steep = 0;
  for (int k = 0; k < 400; ++k) {
    const PreparedMetaballs body =
        prepare_metaballs(potato(1 + k % 60, random.next(), random.uniform(0.7, 9.0), k % 3 == 0));
    const double size = std::pow(10.0, random.uniform(-2.5, -0.7)), height = 0.3 * size;
    const Vec3d corner{random.uniform(-0.6, 0.6), random.uniform(-0.4, 0.4), random.uniform(-0.4, 0.4)};
    const Box box{corner, corner + Vec3d{size, size, size}};
    const MetaballInterval bound = bound_metaballs(body, box, height);
    tighter += bound.gradient_max < 0.99 * bound_metaballs(body, box).gradient_max;
    const double least = smallest_gradient(body, box);
    steep += least > 0.3 * bound.gradient_max;
    for (int i = 0; i < 60; ++i) {
      const auto at = [&](double low) { return static_cast<float>(low + size * random.uniform()); };
      const float x = at(corner.x), y = at(corner.y), z = at(corner.z);
      float s = 0, gx = 0, gy = 0, gz = 0;
      evaluate_metaballs(body, 1, &x, &y, &z, &s, &gx, &gy, &gz);
      const double divisor =
          std::sqrt(squared_norm(Vec3d{gx, gy, gz}) + static_cast<double>(body.parameters.gradient_floor));
      ASSERT_GE(divisor, least);
      if (std::fabs(static_cast<double>(s)) <= height) {
        ASSERT_LE(divisor, bound.gradient_max);
      }
    }
  }
  EXPECT_GT(tighter, 20);
  EXPECT_GT(steep, 20);
}

}  // namespace
}  // namespace astrolith
