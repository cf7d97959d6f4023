#include "synthesis/landforms/population.h"
#include "synthesis/field/bare_body.h"
#include "synthesis/field/implicit_field.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "numerics/errors.h"
#include "synthesis/field/field_mesh.h"
#include "tests/support/refusal.h"
#include "tests/synthesis/bodies.h"

namespace astrolith {
namespace {

Population make_population(int count, double least, double greatest, double exponent) {
  Population population;
  population.count = count;
  population.least_diameter = least;
  population.greatest_diameter = greatest;
  population.exponent = exponent;
  return population;
}

// The maximum-likelihood exponent of a truncated power law, by bisection of its score, and its standard
// error.
struct Exponent {
  double value, error;
};
Exponent fitted_exponent(const std::vector<double>& diameters, double least, double greatest) {
  const double span = std::log(greatest / least), n = static_cast<double>(diameters.size());
  double mean = 0.0;
  for (const double d : diameters) mean += std::log(d / least) / n;
  const auto expected = [&](double b) { return 1.0 / b - span / std::expm1(b * span); };
  double low = 1e-6, high = 50.0;
  for (int i = 0; i < 100; ++i) (expected(0.5 * (low + high)) > mean ? low : high) = 0.5 * (low + high);
  const double s = std::sinh(0.5 * low * span);
  const double information = 1.0 / (low * low) - 0.25 * span * span / (s * s);
  return {low, 1.0 / std::sqrt(n * information)};
}

TEST(Population, ExponentsAreRecovered) {
  const BareSurface surface(bare_body(testing::sphere_recipe(10.0)));
  for (const double exponent : {1.5, 2.0, 2.65, 3.25}) {
    for (const double greatest : {0.2, 5.0}) {
      const Population population = make_population(5000, 0.1, greatest, exponent);
      std::vector<double> diameters;
      for (const DrawnLandform& f : draw_population(population, surface, 3, 0, "r")) {
        ASSERT_TRUE(f.diameter >= 0.1 && f.diameter <= greatest);
        diameters.push_back(f.diameter);
      }
      const Exponent fitted = fitted_exponent(diameters, 0.1, greatest);
      EXPECT_NEAR(fitted.value, exponent, 3.3 * fitted.error) << fitted.error;
    }
  }
}

TEST(Population, NumbersOfADensityArePoissonDistributed) {
  const BareSurface surface(bare_body(testing::sphere_recipe(1.0)));
  Population population = make_population(0, 0.1, 0.2, 2.0);
  population.count.reset();
  population.density = 9.0 / (4.0 * std::numbers::pi);
  const int seeds = 400;
  double sum = 0.0, squares = 0.0, products = 0.0, last = 9.0;
  for (std::uint64_t seed = 0; seed < seeds; ++seed) {
    const double n = static_cast<double>(draw_population(population, surface, seed, 1, "r").size());
    sum += n;
    squares += (n - 9.0) * (n - 9.0);
    products += (n - 9.0) * (last - 9.0);
    last = n;
  }
  EXPECT_NEAR(sum / seeds, 9.0, 4.0 * 3.0 / 20.0);
  EXPECT_NEAR(squares / seeds, 9.0, 4.0 * 9.0 * std::sqrt(2.0 / seeds) * 1.1);
  EXPECT_NEAR(products / seeds, 0.0, 4.0 * 9.0 / 20.0);
}

// Landforms lie on the surface and are uniform over its area: each end of an egg has its share of them.
TEST(Population, PlacesAreUniformOverTheArea) {
  Recipe egg = testing::sphere_recipe(1.0);
  egg.body->blend_exponent = 8.0;
  egg.body->spheres.push_back({{1.2, 0, 0}, 0.5});
  const ImplicitField field(egg);
  MeshCollector collector;
  mesh_field(field, field.bounds(), 80, collector);
  const TriangleMesh& mesh = collector.mesh;
  double area = 0.0, right = 0.0;
  for (const Triangle& t : mesh.triangles) {
    const Vec3d a = mesh.vertices[t[0]], b = mesh.vertices[t[1]], c = mesh.vertices[t[2]];
    const double twice_area = norm(cross(b - a, c - a));
    area += twice_area;
    right += a.x + b.x + c.x > 3.0 ? twice_area : 0.0;
  }
  const BareSurface surface(bare_body(egg));
  EXPECT_NEAR(surface.area(), 0.5 * area, 1e-3 * area);
  int seen = 0, upper = 0;
  const int n = 20000;
  for (const DrawnLandform& f : draw_population(make_population(n, 0.1, 0.2, 2.0), surface, 9, 0, "r")) {
    ASSERT_NEAR(field.value(f.position), 0.0, 1e-5);
    seen += f.position.x > 1.0;
    upper += f.position.z > 0.0;
  }
  const double share = right / area;
  EXPECT_NEAR(seen, n * share, 4.0 * std::sqrt(n * share * (1.0 - share)) + 2e-3 * n);
  EXPECT_NEAR(upper, 0.5 * n, 4.0 * std::sqrt(0.25 * n));
}

// In cells of equal area on a sphere, the counts are as independent as those of a Poisson process.
TEST(Population, PlacesAreIndependent) {
  const BareSurface surface(bare_body(testing::sphere_recipe(1.0)));
  constexpr int kRings = 16, kSectors = 32;
  const double mean = 20.0;
  std::vector<double> counts(kRings * kSectors);
  for (const DrawnLandform& f : draw_population(
           make_population(static_cast<int>(mean) * kRings * kSectors, 0.1, 0.2, 2.0), surface, 4, 2, "r")) {
    const int ring = std::min(kRings - 1, static_cast<int>((f.position.z + 1.0) / 2.0 * kRings));
    const double turn = std::atan2(f.position.y, f.position.x) / (2.0 * std::numbers::pi) + 0.5;
    ++counts[static_cast<std::size_t>(std::max(ring, 0) * kSectors +
                                      static_cast<int>(turn * kSectors) % kSectors)];
  }
  double chi_squared = 0.0;
  for (const double c : counts) chi_squared += (c - mean) * (c - mean) / mean;
  const double freedom = kRings * kSectors - 1;
  EXPECT_NEAR(chi_squared, freedom, 4.0 * std::sqrt(2.0 * freedom));
}

TEST(Population, FeaturesKeepTheirPlacesWhenMoreAreDrawn) {
  const BareSurface surface(bare_body(testing::sphere_recipe(1.0)));
  const auto few = draw_population(make_population(10, 0.1, 0.2, 2.0), surface, 1, 0, "r");
  const auto many = draw_population(make_population(100, 0.1, 0.2, 2.0), surface, 1, 0, "r");
  for (std::size_t i = 0; i < few.size(); ++i) {
    EXPECT_EQ(few[i].position, many[i].position);
    EXPECT_EQ(few[i].diameter, many[i].diameter);
  }
}

TEST(Population, AbsurdDensitiesAreRefused) {
  const BareSurface surface(bare_body(testing::sphere_recipe(1000.0)));
  Population population = make_population(0, 0.1, 0.2, 2.0);
  population.count.reset();
  population.density = 100.0;
  EXPECT_TRUE(testing::has(testing::refusal_text([&] {
                             draw_population(population, surface, 1, 0, "recipe: layers[0].population");
                           }),
                           "population.density: would draw 1.26e+09"));
}

TEST(BareSurface, FindsPlaces) {
  const BareSurface surface(bare_body(testing::sphere_recipe(2.0, {0.5, 0, 0})));
  const Vec3d by_direction = surface.find({{1, 0, 0}, true}, "r");
  EXPECT_NEAR(norm(by_direction - Vec3d{2.5, 0, 0}), 0.0, 1e-5);
  const Vec3d by_position = surface.find({{0.5, 0, 3.0}, false}, "r");
  EXPECT_NEAR(norm(by_position - Vec3d{0.5, 0, 2.0}), 0.0, 1e-4);
  EXPECT_NEAR(norm(surface.normal(by_position) - Vec3d{0, 0, 1}), 0.0, 1e-4);
  EXPECT_THROW(surface.find({{900, 0, 0}, false}, "r"), InputError);
  const BareSurface aside(bare_body(testing::sphere_recipe(1.0, {9, 0, 0})));
  EXPECT_THROW(aside.find({{-1, 0, 0}, true}, "r"), InputError);
}

}  // namespace
}  // namespace astrolith
