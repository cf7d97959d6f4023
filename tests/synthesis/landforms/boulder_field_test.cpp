#include "synthesis/landforms/boulder_field.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "numerics/errors.h"
#include "synthesis/field/bare_body.h"
#include "synthesis/field/implicit_field.h"
#include "tests/synthesis/bodies.h"

namespace astrolith {
namespace {

Boulder boulder_towards(const Vec3d& direction, const Vec3d& axes, double burial) {
  Boulder boulder;
  boulder.place = {direction, true};
  boulder.axes = axes;
  boulder.burial = burial;
  return boulder;
}

// Ellipsoids without facets, noise and joints.
BoulderLayer ellipsoids() {
  BoulderLayer layer;
  layer.smoothing = layer.roughness = layer.angularity = 0.0;
  return layer;
}

Recipe with_boulders(Recipe recipe, const BoulderLayer& layer) {
  recipe.layers.emplace_back(layer);
  return recipe;
}

// The height of the surface above a sphere about the origin, along a direction.
double summit(const ImplicitField& field, const Vec3d& direction, double radius) {
  double low = 0.5 * radius, high = 3.0 * radius;
  for (int i = 0; i < 50; ++i) {
    const double middle = 0.5 * (low + high);
    (field.inside(middle * normalized(direction)) ? low : high) = middle;
  }
  return low - radius;
}

TEST(BoulderField, BurialSaysHowMuchIsSeen) {
  const Recipe sphere = testing::sphere_recipe(10.0);
  for (const double burial : {0.0, 0.25, 0.5, 0.9}) {
    BoulderLayer layer = ellipsoids();
    layer.boulders = {boulder_towards({1, 1, 0.5}, {2.0, 1.4, 1.0}, burial)};
    EXPECT_NEAR(summit(ImplicitField(with_boulders(sphere, layer)), {1, 1, 0.5}, 10.0), 1.0 - burial, 1e-3);
    layer.boulders[0].tilt = 90.0;  // axis b is upright
    EXPECT_NEAR(summit(ImplicitField(with_boulders(sphere, layer)), {1, 1, 0.5}, 10.0), 1.4 * (1.0 - burial),
                1e-3);
  }
}

// No boulder hovers, however rough, tilted and shallow it is.
TEST(BoulderField, EveryBoulderTouchesTheGround) {
  BoulderLayer layer = ellipsoids();
  layer.roughness = 0.5;
  layer.angularity = 1.0;
  BoulderPopulation& population = layer.population.emplace();
  population.drawn.count = 60;
  population.drawn.least_diameter = 0.5;
  population.drawn.greatest_diameter = 3.0;
  population.least_burial = 0.05;
  population.greatest_burial = 0.2;
  population.greatest_tilt = 90.0;
  const ImplicitField field(with_boulders(testing::sphere_recipe(10.0), layer));
  for (const PlacedBoulder& boulder : field.boulders()[0].boulders) {
    const double height = norm(boulder.center) - 10.0;
    for (double t = 0.0; t < height; t += 0.02) {
      ASSERT_TRUE(field.inside(boulder.center - t * normalized(boulder.center))) << t << " of " << height;
    }
  }
}

// Ground that falls three times as fast as the distance, which steps by F overshoot ever more.
TEST(BoulderField, LiesOnSteepGround) {
  const BareSurface surface(bare_body(testing::sphere_recipe(10.0)));
  const Terrain steep{[](const Vec3d& p) { return 3.0 * (10.3 - norm(p)); }, 1.0};
  BoulderLayer layer = ellipsoids();
  layer.boulders = {boulder_towards({1, 1, 0.5}, {0.4, 0.4, 0.4}, 0.5)};
  const std::vector<PlacedBoulder> placed = place_boulders(layer, surface, steep, 1, 0, "layers[0]");
  EXPECT_NEAR(norm(placed.at(0).center), 10.3, 1e-3);
}

// Facets cut into the ellipsoid, each boulder's in its own way, and leave flat ground: along most chords of
// the surface between near directions the middle lies on it too.
TEST(BoulderField, FacetsAreFlatAndCutIntoTheEllipsoid) {
  BoulderLayer layer = ellipsoids();
  layer.boulders = {boulder_towards({0, 0, 1}, {2, 2, 2}, 0.0), boulder_towards({0, 1, 0}, {2, 2, 2}, 0.0)};
  layer.angularity = 1.0;
  const ImplicitField field(with_boulders(testing::sphere_recipe(10.0), layer));
  CounterRandom random(3);
  const auto radius = [&](const Vec3d& center, const Vec3d& direction) {
    double in = 0.0, out = 1.2;
    for (int i = 0; i < 40; ++i) {
      const double middle = 0.5 * (in + out);
      (field.inside(center + middle * direction) ? in : out) = middle;
    }
    return in;
  };
  double sum[2] = {0.0, 0.0}, differences = 0.0;
  int flat = 0;
  constexpr int kDirections = 400;
  for (int i = 0; i < kDirections; ++i) {
    const Vec3d up{0, 0, 1},
        d = normalized(Vec3d{random.normal(), random.normal(), random.uniform(0.2, 1.0)});
    const Vec3d first = field.boulders()[0].boulders[0].center,
                second = field.boulders()[0].boulders[1].center;
    const double r = radius(first, d), of_second = radius(second, {d.x, d.z, d.y});
    ASSERT_LE(r, 1.0 + 1e-4);
    ASSERT_GE(r, 0.59);
    sum[0] += r, sum[1] += of_second;
    differences += std::fabs(r - of_second);
    const Vec3d beside = normalized(d + 0.1 * cross(d, up));
    const Vec3d middle = 0.5 * (r * d + radius(first, beside) * beside);
    flat += std::fabs(radius(first, normalized(middle)) - norm(middle)) < 2e-4;
  }
  EXPECT_LT(sum[0] / kDirections, 0.92);
  EXPECT_GT(differences / kDirections, 0.02);
  EXPECT_GT(flat, kDirections / 2);
}

// At a place on +x, east is +y. Axis a lies along east, and with a heading of 90 along north.
TEST(BoulderField, AxesLieAsTheHeadingSays) {
  BoulderLayer layer = ellipsoids();
  layer.boulders = {boulder_towards({1, 0, 0}, {2.0, 1.0, 1.0}, 0.5)};
  const Recipe sphere = testing::sphere_recipe(10.0);
  const ImplicitField east(with_boulders(sphere, layer));
  EXPECT_TRUE(east.inside({10.1, 0.9, 0.0}));
  EXPECT_FALSE(east.inside({10.1, 0.0, 0.9}));
  layer.boulders[0].heading = 90.0;
  const ImplicitField north(with_boulders(sphere, layer));
  EXPECT_FALSE(north.inside({10.1, 0.9, 0.0}));
  EXPECT_TRUE(north.inside({10.1, 0.0, 0.9}));
}

// The direction against gravity and centrifugal force on a ball about the origin, by hand.
Vec3d ball_vertical(const Vec3d& p, const LocalGravity& gravity) {
  const double turn = 2.0 * std::numbers::pi / (3600.0 * gravity.rotation_period);
  const double pull = 4.0 / 3.0 * std::numbers::pi * 6.6743e-11 * gravity.density;
  return normalized(pull * p - turn * turn * Vec3d{p.x, p.y, 0.0});
}

double degrees_between(const Vec3d& a, const Vec3d& b) {
  return std::atan2(norm(cross(a, b)), dot(a, b)) * (180.0 / std::numbers::pi);
}

BoulderLayer upright_boulders() {
  BoulderLayer layer = ellipsoids();
  BoulderPopulation& population = layer.population.emplace();
  population.drawn.count = 300;
  population.drawn.least_diameter = 0.2;
  population.drawn.greatest_diameter = 1.0;
  population.greatest_tilt = 0.0;
  return layer;
}

// At the equator of this ball the centrifugal force is .6 of gravity. The vertical leans by up to 25 degrees.
TEST(BoulderField, StandUprightInTheGravityOfAFastRotator) {
  const Recipe sphere = testing::sphere_recipe(10.0);
  BoulderLayer layer = upright_boulders();
  const ImplicitField still(with_boulders(sphere, layer));
  layer.gravity = LocalGravity{2000.0, 3.0};
  const ImplicitField turning(with_boulders(sphere, layer));
  double greatest_lean = 0.0;
  for (std::size_t i = 0; i < 300; ++i) {
    const PlacedBoulder& at_rest = still.boulders()[0].boulders[i];
    const PlacedBoulder& leaning = turning.boulders()[0].boulders[i];
    const Vec3d normal = normalized(at_rest.center), foot = 10.0 * normal;
    const Vec3d vertical = ball_vertical(foot, *layer.gravity);
    EXPECT_LT(degrees_between(at_rest.directions[2], normal), 1e-3);
    EXPECT_LT(degrees_between(leaning.directions[2], vertical), 0.2);
    // The foot stays, and the centre lies along the vertical, as high as along the normal before.
    EXPECT_NEAR(norm(leaning.center - foot), std::fabs(norm(at_rest.center) - 10.0), 2e-3);
    EXPECT_LT(norm(cross(leaning.center - foot, vertical)), 5e-3);
    greatest_lean = std::max(greatest_lean, degrees_between(leaning.directions[2], normal));
  }
  EXPECT_GT(greatest_lean, 20.0);
}

// Here the centrifugal force exceeds gravity at the equator. Stones there stand along the normal.
TEST(BoulderField, StandAlongTheNormalWhereNothingRests) {
  BoulderLayer layer = ellipsoids();
  layer.boulders = {boulder_towards({1, 0, 0}, {1, 1, 0.5}, 0.3),
                    boulder_towards({0, 0.6, 0.8}, {1, 1, 0.5}, 0.3)};
  layer.gravity = LocalGravity{2000.0, 2.0};
  const ImplicitField field(with_boulders(testing::sphere_recipe(10.0), layer));
  const std::vector<PlacedBoulder>& boulders = field.boulders()[0].boulders;
  EXPECT_LT(degrees_between(boulders[0].directions[2], {1, 0, 0}), 1e-3);
  EXPECT_LT(degrees_between(boulders[1].directions[2], ball_vertical({0, 6, 8}, *layer.gravity)), 0.2);
}

// The mesh of the bare body has no facet of these two grains.
TEST(BoulderField, GravityThatIsUnknownIsRefused) {
  Recipe grains = testing::sphere_recipe(0.01, {-10, 0, 0});
  grains.body->spheres.push_back({{10, 0, 0}, 0.01});
  BoulderLayer layer = ellipsoids();
  layer.boulders = {boulder_towards({1, 0, 0}, {1e-3, 1e-3, 1e-3}, 0.5)};
  EXPECT_NO_THROW(ImplicitField(with_boulders(grains, layer)));
  layer.gravity.emplace();
  EXPECT_THROW(ImplicitField(with_boulders(grains, layer)), InputError);
}

// Boulders lie on the hills and in the craters of layers that come before or after them in the recipe.
TEST(BoulderField, StandsOnTheFinalSurface) {
  Recipe recipe = testing::sphere_recipe(10.0);
  BoulderLayer boulders = ellipsoids();
  boulders.boulders = {boulder_towards({0, 0, 1}, {0.6, 0.6, 0.6}, 0.5)};
  recipe.layers.emplace_back(boulders);
  CraterLayer craters;
  craters.craters.emplace_back().place = {{0, 0, 1}, true};
  craters.craters[0].diameter = 4.0;
  recipe.layers.emplace_back(craters);
  recipe.layers.emplace_back(testing::fractal_layer(0.1, 0.3, 2));
  const ImplicitField with(recipe);
  recipe.layers[0] = BoulderLayer{};  // others keep their numbers, which seed them
  const ImplicitField without(recipe);
  const double floor = summit(without, {0, 0, 1}, 10.0);
  EXPECT_LT(floor, -0.2);
  EXPECT_NEAR(summit(with, {0, 0, 1}, 10.0), floor + 0.3, 0.01);
}

TEST(BoulderField, UnionChangesNothingElsewhere) {
  BoulderLayer layer = ellipsoids();
  layer.smoothing = 0.5;
  layer.roughness = 0.2;
  layer.boulders = {boulder_towards({0, 0, 1}, {2.0, 1.5, 1.0}, 0.5)};
  const Recipe sphere = testing::sphere_recipe(10.0);
  const ImplicitField with(with_boulders(sphere, layer)), without(sphere);
  CounterRandom random(1);
  for (int i = 0; i < 2000; ++i) {
    const Vec3d p{random.uniform(-11, 11), random.uniform(-11, 11), random.uniform(-11, 11)};
    ASSERT_GE(with.value(p), without.value(p));  // a union only adds
    if (norm(p - Vec3d{0, 0, 10}) > 1.0 * (1.0 + 0.7) + 0.01) {
      ASSERT_EQ(with.value(p), without.value(p));
    }
  }
}

TEST(BoulderField, BouldersLongerThanTheBodyAreRefused) {
  BoulderLayer layer = ellipsoids();
  layer.boulders = {boulder_towards({0, 0, 1}, {3, 3, 3}, 0.5)};
  EXPECT_THROW(ImplicitField(with_boulders(testing::sphere_recipe(1.0), layer)), InputError);
}

}  // namespace
}  // namespace astrolith
