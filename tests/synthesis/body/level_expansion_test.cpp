#include "synthesis/body/level_expansion.h"

#include <gtest/gtest.h>

#include <cmath>

#include "numerics/hash_random.h"
#include "synthesis/body/surface_projection.h"
#include "tests/synthesis/bodies.h"

namespace astrolith {
namespace {

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
