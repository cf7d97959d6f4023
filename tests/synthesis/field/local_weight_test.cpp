#include "synthesis/field/local_weight.h"

#include <vector>

#include "numerics/errors.h"
#include "numerics/scalar_math.h"
#include "synthesis/field/implicit_field.h"
#include "tests/support/points.h"
#include "tests/synthesis/bodies.h"

namespace astrolith {
namespace {

using testing::FloatPoints;

// A potato with two groups: its spheres left of x = 0, and all others.
Recipe halves(int num_spheres, std::uint64_t seed) {
  Recipe recipe = testing::potato_recipe(num_spheres, seed);
  SphereGroup left{"left", {}}, right{"right", {}};
  for (int i = 0; i < num_spheres; ++i) {
    const bool is_left = recipe.body->spheres[static_cast<std::size_t>(i)].center.x < 0.0;
    (is_left ? left : right).spheres.push_back(i);
  }
  recipe.body->groups = {left, right};
  return recipe;
}

struct LoneWeight {
  LoneWeight(const Locality& locality, const MetaballBody& body)
      : tables(make_local_weight(locality, body, "layer", arrays)) {}

  ArrayStore arrays;
  LocalWeight tables;
};

std::vector<float> weights(const LoneWeight& weight, const FloatPoints& p) {
  std::vector<float> w(p.x.size(), 1.0f);
  multiply_by_weight(weight.tables, weight.arrays.view(), static_cast<int>(w.size()), p.x.data(), p.y.data(),
                     p.z.data(), w.data());
  return w;
}
// The weight of a lone point.
float lone_weight(const LoneWeight& weight, const Vec3f& p) {
  return weight_at(weight.tables, weight.arrays.view(), p);
}
Interval find_bound(const LoneWeight& weight, const Box& box) {
  return bound_weight(weight.tables, weight.arrays.view(), box);
}

const Box kAbout{{-0.6, -0.4, -0.4}, {0.6, 0.4, 0.4}};
// A cube with its least corner about the potato, of a side between 10^low and 10^high.
Box random_cube(CounterRandom& random, double low, double high) {
  const Vec3d corner = testing::random_point(random, kAbout);
  const double size = std::pow(10.0, random.uniform(low, high));
  return {corner, corner + Vec3d{size, size, size}};
}

double nearest(const MetaballBody& body, const SphereGroup& group, const Vec3d& p) {
  double least = 1e300;
  for (const int i : group.spheres) {
    const Sphere& s = body.spheres[static_cast<std::size_t>(i)];
    least = std::min(least, norm(p - s.center) - s.radius);
  }
  return least;
}

TEST(LocalWeight, IsTheFormulaAndAddsUpToOne) {
  const MetaballBody body = *halves(80, 3).body;
  const double width = 0.05;
  const LoneWeight left({"left", width}, body), right({"right", width}, body);
  CounterRandom random(1);
  const FloatPoints points(random, {{-1, -0.5, -0.5}, {1, 0.5, 0.5}}, 2000);
  const std::vector<float> l = weights(left, points), r = weights(right, points);
  int near_one = 0;
  for (std::size_t i = 0; i < l.size(); ++i) {
    const Vec3d p{points.x[i], points.y[i], points.z[i]};
    const double d = nearest(body, body.groups[0], p) - nearest(body, body.groups[1], p);
    ASSERT_NEAR(l[i], 0.5 - std::atan(d / width) / 3.14159265358979, 1e-5);
    ASSERT_NEAR(l[i] + r[i], 1.0, 1e-5);
    ASSERT_TRUE(l[i] >= 0.0f && l[i] <= 1.0f);
    near_one += l[i] > 0.9f;
  }
  EXPECT_GT(near_one, 500);
}

TEST(LocalWeight, BitsDependOnThePointAlone) {
  const MetaballBody body = *halves(120, 5).body;
  const LoneWeight weight({"left", 0.02}, body);
  CounterRandom random(2);
  const FloatPoints points(random, kAbout, 700);
  const std::vector<float> together = weights(weight, points);
  for (std::size_t i = 0; i < together.size(); ++i) {
    const Vec3f p{points.x[i], points.y[i], points.z[i]};
    FloatPoints alone;
    alone.add({p.x, p.y, p.z});
    ASSERT_EQ(math::to_bits(weights(weight, alone)[0]), math::to_bits(together[i]));
    ASSERT_EQ(math::to_bits(lone_weight(weight, p)), math::to_bits(together[i]));
  }
}

// The search for the nearest of many spheres leaves out none that counts.
TEST(LocalWeight, ManySpheresAreTheNearestOnes) {
  const MetaballBody body = *halves(3000, 4).body;
  const LoneWeight weight({"left", 0.01}, body);
  CounterRandom random(7);
  for (int k = 0; k < 30; ++k) {
    const Box box = random_cube(random, -3.0, 0.0);
    const FloatPoints points(random, box, 300);
    const std::vector<float> together = weights(weight, points);
    const Interval bound = find_bound(weight, box);
    for (std::size_t i = 0; i < together.size(); ++i) {
      const float alone = lone_weight(weight, {points.x[i], points.y[i], points.z[i]});
      ASSERT_EQ(math::to_bits(alone), math::to_bits(together[i]));
      ASSERT_TRUE(together[i] >= bound.low && together[i] <= bound.high);
    }
  }
}

TEST(LocalWeight, BoundsHoldEveryValue) {
  CounterRandom random(6);
  int narrow = 0;
  for (int k = 0; k < 300; ++k) {
    const MetaballBody body = *halves(2 + k % 60, random.next()).body;
    if (body.groups[0].spheres.empty() || body.groups[1].spheres.empty()) continue;
    const LoneWeight weight({"left", std::pow(10.0, random.uniform(-3.0, -0.5))}, body);
    const Box box = random_cube(random, -3.0, -0.5);
    const Interval bound = find_bound(weight, box);
    narrow += bound.high - bound.low < 0.2;
    for (const float w : weights(weight, FloatPoints(random, box, 50))) {
      ASSERT_GE(w, bound.low);
      ASSERT_LE(w, bound.high);
    }
  }
  EXPECT_GT(narrow, 100);
}

TEST(LocalWeight, AGroupOfAllSpheresIsEverywhere) {
  Recipe recipe = testing::potato_recipe(5, 1);
  recipe.body->groups = {{"all", {0, 1, 2, 3, 4}}};
  EXPECT_EQ(lone_weight(LoneWeight({"all", 1.0}, *recipe.body), {3, 0, 0}), 1.0f);
}

TEST(LocalWeight, NeedsItsGroup) {
  EXPECT_THROW(LoneWeight({"middle", 1.0}, *halves(10, 1).body), InputError);
}

// A layer on the left half leaves the far right as it is, and no box is proved empty that holds surface.
TEST(LocalWeight, KeepsLayersWhereTheyBelong) {
  Recipe recipe = halves(60, 8);
  const ImplicitField bare(recipe);
  FractalLayer layer = testing::fractal_layer(0.1, 6.0, 2);
  recipe.layers = {layer};
  const ImplicitField everywhere(recipe);
  layer.use.locality = Locality{"left", 0.003};
  recipe.layers = {layer};
  const ImplicitField left(recipe);
  CounterRandom random(3);
  int proved = 0;
  for (int k = 0; k < 400; ++k) {
    const Box box = random_cube(random, -2.5, -1.0);
    const BlockContent content = left.gather(box).content();
    proved += content != BlockContent::kMixed;
    for (int i = 0; i < 40; ++i) {
      const Vec3d p = testing::random_point(random, box);
      if (content != BlockContent::kMixed) {
        ASSERT_EQ(left.inside(p), content == BlockContent::kInside);
      }
      const double height = everywhere.value(p) - bare.value(p), local = left.value(p) - bare.value(p);
      ASSERT_LE(std::fabs(local), std::fabs(height) + 1e-4);
    }
  }
  EXPECT_GT(proved, 100);
  const Vec3d far_left{-0.45, 0.0, 0.0}, far_right{0.45, 0.0, 0.0};
  EXPECT_NEAR(left.value(far_left), everywhere.value(far_left), 0.02);
  EXPECT_NEAR(left.value(far_right), bare.value(far_right), 0.02);
}

}  // namespace
}  // namespace astrolith
