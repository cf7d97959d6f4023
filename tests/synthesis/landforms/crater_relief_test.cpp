#include "synthesis/landforms/crater_relief.h"
#include "synthesis/field/bare_body.h"

#include <algorithm>
#include <cmath>

#include "numerics/errors.h"
#include "synthesis/field/field_mesh.h"
#include "tests/support/refusal.h"
#include "tests/synthesis/bodies.h"

namespace astrolith {
namespace {

Crater crater_towards(const Vec3d& direction, double diameter, double age = 0.0) {
  Crater crater;
  crater.place = {direction, true};
  crater.diameter = diameter;
  crater.age = age;
  return crater;
}

Recipe cratered_sphere(double radius, const CraterLayer& layer) {
  Recipe recipe = testing::sphere_recipe(radius);
  recipe.layers.emplace_back(layer);
  return recipe;
}

// The elevation on a sphere about the origin in a direction. F on the bare sphere is the elevation, since s =
// 0.
double elevation_along(const ImplicitField& field, double radius, const Vec3d& direction) {
  const Vec3d p = radius * normalized(direction);
  return field.value(p);
}

// The profile's formula in double precision, without smoothing and terraces.
double plain_profile(const CraterProfile& p, double diameter, double x) {
  const double wall = 1.0 + p.sharpness * (x * x - 1.0);
  const double cavity = (p.depth + p.rim_height) * wall - p.depth;
  const double rim = x < p.extent ? p.rim_height * std::pow((p.extent - x) / (p.extent - 1.0), p.flank) : 0.0;
  const double peak =
      x < p.peak_radius ? p.peak_height * std::pow(1.0 - std::pow(x / p.peak_radius, 2), 2) : 0.0;
  return diameter * (std::max(std::min(cavity, rim), -p.depth) + peak);
}

Vec3d tilted(double angle, double turn) {
  return {std::sin(angle) * std::cos(turn), std::sin(angle) * std::sin(turn), std::cos(angle)};
}

TEST(CraterProfile, IsItsFormula) {
  CraterLayer layer;
  layer.complex.smoothing = 0.0;
  layer.complex.terraces = 0;
  for (const bool complex : {false, true}) {
    if (complex) layer.complex_from = 1.0;
    layer.craters = {crater_towards({0, 0, 1}, 2.0)};
    const ImplicitField field(cratered_sphere(20.0, layer));
    const CraterProfile& profile = complex ? layer.complex : layer.simple;
    for (double x = 0.0; x < 3.0; x += 0.01) {
      const double angle = 2.0 * std::asin(x / 2.0 / 20.0);  // a chord of x radii
      const double height = elevation_along(field, 20.0, tilted(angle, 7.0 * x));
      ASSERT_NEAR(height, plain_profile(profile, 2.0, x), 1e-4) << x;
    }
  }
}

TEST(CraterProfile, SmoothJointsAndTerracesKeepFloorRimAndOrder) {
  CraterKernel kernel{};
  kernel.depth = 2.0f;
  kernel.rim_height = 0.5f;
  kernel.sharpness = 2.0f;
  kernel.extent = 2.5f;
  kernel.extent_squared = 6.25f;
  kernel.inverse_flank_width = 1.0f / 1.5f;
  kernel.flank = 2.0f;
  kernel.inverse_peak_radius_squared = 4.0f;
  CraterKernel smooth = kernel, stepped = kernel;
  smooth.smoothing = 0.4f;
  stepped.terraces = 3.0f;
  float last = -3.0f;
  for (float x = 0.0f; x < 2.6f; x += 0.01f) {
    const float plain = crater_height(kernel, x * x);
    ASSERT_LE(std::fabs(crater_height(smooth, x * x) - plain), 0.1f + 1e-5f);
    ASSERT_LE(std::fabs(crater_height(stepped, x * x) - plain), 2.5f / 6.0f + 1e-5f);
    if (x <= 1.0f) {
      ASSERT_GE(crater_height(stepped, x * x), last - 1e-6f);
      last = crater_height(stepped, x * x);
    }
  }
  EXPECT_FLOAT_EQ(crater_height(smooth, 0.0f), -2.0f);
  EXPECT_NEAR(crater_height(smooth, 1.0f), 0.5f - 0.1f, 1e-5f);  // k/4 below
  EXPECT_EQ(crater_height(smooth, 6.26f), 0.0f);
  for (const float v : {0.0f, 1.0f / 3.0f, 2.0f / 3.0f, 1.0f, -0.5f, 1.5f}) {
    EXPECT_NEAR(terraced(v, 3.0f), v, 1e-6f);
    EXPECT_EQ(terraced(v, 0.0f), v);
  }
}

// Depth, rim and diameter are measured on the mesh of a large sphere.
TEST(CraterRelief, MeshesHaveTheStatedDepthRimAndDiameter) {
  CraterLayer layer;
  Crater crater = crater_towards({0.3, -0.2, 1.0}, 6.0);
  crater.depth = 0.6;
  crater.rim_height = 0.25;
  layer.craters = {crater};
  const ImplicitField field(cratered_sphere(10.0, layer));
  MeshCollector collector;
  mesh_field(field, field.bounds(), 180, collector);
  const Vec3d axis = normalized(crater.place.vector);
  double lowest = 0.0, highest = 0.0, crest = 0.0;
  for (const Vec3d& v : collector.mesh.vertices) {
    const double elevation = norm(v) - 10.0, chord = norm(10.0 * normalized(v) - 10.0 * axis);
    lowest = std::min(lowest, elevation);
    if (elevation > highest) highest = elevation, crest = 2.0 * chord;
  }
  EXPECT_NEAR(lowest, -0.6, 0.02);  // F is a distance to first order: 0.6 deep in a radius of 10 is 3 % less
  EXPECT_NEAR(highest, 0.25, 0.015);
  EXPECT_NEAR(crest, 6.0, 0.15);
}

// A small crater within a large one vanishes if it is older, and lies on the large one's floor if it is
// younger.
TEST(CraterRelief, YoungerCratersObscureOlder) {
  const double radius = 50.0;
  CraterLayer layer;
  layer.craters = {crater_towards({0, 0, 1}, 2.0, 1.0), crater_towards({0, 0.002, 1}, 0.4, 2.0)};
  const Vec3d small_center{0, 0.002, 1};
  const auto elevation = [&](const Vec3d& direction) {
    return elevation_along(ImplicitField(cratered_sphere(radius, layer)), radius, direction);
  };
  const double with_older = elevation(small_center);
  EXPECT_NEAR(elevation({0, 0, 1}), -0.2, 1e-3);  // nothing left of the small one at the large one's centre
  layer.craters[1].age = 0.5;
  const double with_younger = elevation(small_center);
  EXPECT_NEAR(with_older, -0.2, 8e-3);           // the older one fades with the square of the distance
  EXPECT_NEAR(with_younger, -0.2 - 0.04, 6e-3);  // on the floor of the large one
}

// The base of a young crater within an old one is the old floor; of equal ages the later one is younger.
TEST(CraterRelief, BasesAreSampledFromWhatIsOlderAndNotSmaller) {
  const double radius = 50.0;
  CraterLayer layer;
  layer.simple.sharpness = 3.0;
  layer.craters = {crater_towards({0, 0, 1}, 4.0), crater_towards({0.005, 0, 1}, 1.0)};
  const ImplicitField field(cratered_sphere(radius, layer));
  EXPECT_NEAR(elevation_along(field, radius, {0.005, 0, 1}), -0.4 - 0.1, 2e-3);
  std::swap(layer.craters[0], layer.craters[1]);
  const ImplicitField other(cratered_sphere(radius, layer));
  EXPECT_NEAR(elevation_along(other, radius, {0, 0, 1}), -0.4, 2e-3);  // the small one is no base
}

// Craters obscure a layer before them, and a layer after them lies on top.
TEST(CraterRelief, OrderOfLayersMatters) {
  CraterLayer layer;
  layer.craters = {crater_towards({0, 0, 1}, 6.0)};
  Recipe recipe = cratered_sphere(30.0, layer);
  const FractalLayer hills = testing::fractal_layer(0.2, 1.0, 1);
  const auto roughness = [&](const Recipe& r) {
    const ImplicitField field(r);
    double low = 1e9, high = -1e9;
    for (int i = 0; i < 100; ++i) {
      const double e = elevation_along(field, 30.0, tilted(0.01 * std::sqrt(i / 100.0), i * 2.4));
      low = std::min(low, e), high = std::max(high, e);
    }
    return high - low;
  };
  const double bare = roughness(recipe);
  recipe.layers.emplace_back(hills);
  const double after = roughness(recipe);
  std::swap(recipe.layers[0], recipe.layers[1]);
  const double before = roughness(recipe);
  EXPECT_LT(before, bare + 0.01);
  EXPECT_GT(after, bare + 0.05);
}

// A crater changes no bit beyond its extent.
TEST(CraterRelief, NothingBeyondTheExtent) {
  CraterLayer layer;
  layer.craters = {crater_towards({0, 0, 1}, 2.0)};
  const ImplicitField with(cratered_sphere(10.0, layer)), without(testing::sphere_recipe(10.0));
  for (int i = 0; i < 500; ++i) {
    const Vec3d p = 10.01 * tilted(0.252 + 2.8 * i / 500, i);
    ASSERT_EQ(with.value(p), without.value(p));
  }
}

CraterLayer random_craters(CounterRandom& random, double size) {
  CraterLayer layer;
  layer.simple.depth = random.uniform(0.0, 0.3);
  layer.simple.smoothing = random.uniform() < 0.5 ? 0.0 : random.uniform();
  layer.simple.extent = random.uniform(1.05, 4.0);
  layer.simple.sharpness = random.uniform(1.0, 4.0);
  layer.complex_from = 0.2 * size;
  layer.complex.terraces = static_cast<int>(random.below(5));
  layer.complex.peak_height = random.uniform(0.0, 0.1);
  CraterPopulation& population = layer.population.emplace();
  population.drawn.count = 1 + static_cast<int>(random.below(60));
  population.drawn.least_diameter = 0.03 * size;
  population.drawn.greatest_diameter = 0.5 * size;
  population.depth_spread = random.uniform();
  population.degradation = random.uniform();
  return layer;
}

TEST(CraterRelief, BoundsOverBoxesAreNeverWrong) {
  CounterRandom random(5);
  int tight = 0;
  for (int k = 0; k < 30; ++k) {
    const CraterLayer layer = random_craters(random, 2.0);
    const BareSurface surface(bare_body(testing::sphere_recipe(1.0)));
    const auto craters = place_craters(layer, surface, random.next(), 0, "r");
    std::vector<Vec3d> centers;
    std::vector<float> before;
    for (const PlacedCrater& crater : craters) {
      centers.push_back(crater.position);
      before.push_back(static_cast<float>(random.uniform(-0.05, 0.05)));
    }
    ArrayStore arrays;
    const CraterRelief relief = make_crater_relief(layer, craters, centers, before, 0.05, arrays);
    const BoxTree tree = crater_tree(arrays.view().span(relief.craters));
    for (int b = 0; b < 60; ++b) {
      const double size = std::pow(10.0, random.uniform(-2.0, 0.0));
      const Vec3d corner{random.uniform(-1.2, 1.0), random.uniform(-1.2, 1.0), random.uniform(-1.2, 1.0)};
      const Box box{corner, corner + Vec3d{size, size, size}};
      const auto for_each_reaching = [&](const auto& visit) {
        for (const std::uint32_t number : tree.touching(box)) visit(number);
      };
      const Interval bound =
          bound_cratered_elevation(relief, arrays.view(), for_each_reaching, box, {-0.05, 0.05});
      for (int i = 0; i < 40; ++i) {
        const float x = static_cast<float>(random.uniform(box.min.x, box.max.x)),
                    y = static_cast<float>(random.uniform(box.min.y, box.max.y)),
                    z = static_cast<float>(random.uniform(box.min.z, box.max.z));
        float e = static_cast<float>(random.uniform(-0.05, 0.05));
        apply_craters(relief, arrays.view(), tree, 1, &x, &y, &z, &e);
        ASSERT_GE(double{e}, bound.low - 1e-7);
        ASSERT_LE(double{e}, bound.high + 1e-7);
      }
      tight += bound.high - bound.low < 0.6 * relief.elevation_bound;
    }
  }
  EXPECT_GT(tight, 200);
}

TEST(CraterRelief, CratersWiderThanTheBodyAreRefused) {
  CraterLayer layer;
  layer.craters = {crater_towards({0, 0, 1}, 1.0), crater_towards({0, 0, 1}, 2.5)};
  EXPECT_TRUE(testing::has(testing::refusal_text([&] { ImplicitField field(cratered_sphere(1.0, layer)); }),
                           "layers[0].craters[1].diameter: is 2.5"));
}

TEST(CraterRelief, CratersPiledUpWithoutEndAreRefused) {
  CraterLayer layer;
  CraterPopulation& population = layer.population.emplace();
  population.drawn.count = 20000;
  population.drawn.least_diameter = population.drawn.greatest_diameter = 1.0;
  EXPECT_THROW(ImplicitField(cratered_sphere(1.0, layer)), InputError);
}

}  // namespace
}  // namespace astrolith
