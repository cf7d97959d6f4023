// Where populations are drawn, and with what sizes: weights, clusters, Weibull's law and cells.
#include <algorithm>
#include <cmath>
#include <numbers>

#include "numerics/errors.h"
#include "synthesis/field/bare_body.h"
#include "synthesis/landforms/population.h"
#include "synthesis/landforms/population_cells.h"
#include "tests/support/refusal.h"
#include "tests/synthesis/bodies.h"

namespace astrolith {
namespace {

constexpr int kBands = 20;  // of equal area on a sphere

Population sizes_between(double least, double greatest, double exponent) {
  Population population;
  population.least_diameter = least;
  population.greatest_diameter = greatest;
  population.exponent = exponent;
  return population;
}

Population counted(int count) {
  Population population = sizes_between(0.01, 0.02, 2.0);
  population.count = count;
  return population;
}

BareSurface ball_surface() { return BareSurface(bare_body(testing::sphere_recipe(1.0))); }

// The weight t^2 of places on the unit sphere, with t from 0 at the south pole to 1 at the north pole.
float northern_weight(const Vec3d& p) {
  const double t = std::clamp(0.5 * (p.z + 1.0), 0.0, 1.0);
  return static_cast<float>(t * t);
}
// The mean of the weight over a band.
double band_weight(int band) {
  const double a = static_cast<double>(band) / kBands, b = (band + 1.0) / kBands;
  return (b * b * b - a * a * a) / 3.0 * kBands;
}

std::vector<double> counts_in_bands(const std::vector<DrawnLandform>& landforms) {
  std::vector<double> counts(kBands);
  for (const DrawnLandform& f : landforms) {
    const int band = static_cast<int>(0.5 * (f.position.z + 1.0) * kBands);
    ++counts[static_cast<std::size_t>(std::clamp(band, 0, kBands - 1))];
  }
  return counts;
}

double chi_squared(const std::vector<double>& counts, const std::vector<double>& expected) {
  double sum = 0.0;
  for (std::size_t i = 0; i < counts.size(); ++i) {
    sum += (counts[i] - expected[i]) * (counts[i] - expected[i]) / expected[i];
  }
  return sum;
}
// The limit that chance exceeds about once in a thousand times (Wilson and Hilferty 1931).
double chi_limit(int freedom) {
  const double v = 2.0 / (9.0 * freedom), c = 1.0 - v + 3.09 * std::sqrt(v);
  return freedom * c * c * c;
}

// The bands of no area near the south pole are left out, where fewer than five landforms are expected.
void expect_northern(const std::vector<DrawnLandform>& landforms, double number) {
  std::vector<double> counts, expected;
  const std::vector<double> all = counts_in_bands(landforms);
  for (int band = 0; band < kBands; ++band) {
    const double mean = number * band_weight(band) / kBands;
    if (mean < 5.0) continue;
    counts.push_back(all[static_cast<std::size_t>(band)]);
    expected.push_back(mean);
  }
  ASSERT_GT(counts.size(), 15u);
  EXPECT_LT(chi_squared(counts, expected), chi_limit(static_cast<int>(counts.size()) - 1));
}

TEST(PopulationPlaces, CountsFollowTheWeight) {
  const BareSurface surface = ball_surface();
  const auto landforms = draw_population(counted(20000), surface, 1, 0, "r", {northern_weight});
  ASSERT_EQ(landforms.size(), 20000u);
  expect_northern(landforms, 20000.0 * 3.0);  // the weight is 1/3 on average
}

TEST(PopulationPlaces, DensitiesAreThinnedByTheWeight) {
  const BareSurface surface = ball_surface();
  Population population = sizes_between(0.01, 0.02, 2.0);
  population.density = 5000.0;
  const double number = 5000.0 * surface.area();
  const auto landforms = draw_population(population, surface, 1, 0, "r", {northern_weight});
  EXPECT_NEAR(static_cast<double>(landforms.size()), number / 3.0, 4.0 * std::sqrt(number / 3.0));
  expect_northern(landforms, number);
}

// A weight of 1 everywhere changes no size: diameters and places have random numbers of their own.
TEST(PopulationPlaces, WeightsChangeNoSize) {
  const BareSurface surface = ball_surface();
  const auto plain = draw_population(counted(50), surface, 1, 0, "r");
  const auto weighted = draw_population(counted(50), surface, 1, 0, "r", {northern_weight});
  for (std::size_t i = 0; i < plain.size(); ++i) EXPECT_EQ(plain[i].diameter, weighted[i].diameter);
}

TEST(PopulationPlaces, WeightsOfNothingAreRefused) {
  const BareSurface surface = ball_surface();
  const auto nowhere = [](const Vec3d&) { return 0.0f; };
  EXPECT_TRUE(testing::has(testing::refusal_text([&] {
                             draw_population(counted(5), surface, 1, 0, "recipe: layers[0].population",
                                             {nowhere});
                           }),
                           "recipe: layers[0].population: 5 of its landforms found no place"));
}

TEST(PopulationPlaces, ProgressStopsTheSearch) {
  const BareSurface surface = ball_surface();
  DrawingPlaces places{northern_weight};
  places.progress = [](double, std::string_view) { return false; };
  EXPECT_THROW(draw_population(counted(5), surface, 1, 0, "r", places), WorkError);
}

// Landforms of one cluster lie about its centre with the stated standard deviation along each tangent.
TEST(PopulationPlaces, ClustersHaveTheirRadius) {
  const BareSurface surface = ball_surface();
  Population population = counted(4000);
  population.clusters = Clusters{1, 0.05, 1.0};
  const auto landforms = draw_population(population, surface, 5, 0, "r");
  Vec3d center;
  for (const DrawnLandform& f : landforms) center += f.position;
  center = normalized(center);
  double squares = 0.0;
  for (const DrawnLandform& f : landforms) squares += squared_norm(cross(f.position, center)) / 4000.0;
  EXPECT_NEAR(std::sqrt(0.5 * squares), 0.05, 0.05 * 4.0 / std::sqrt(2.0 * 4000.0) + 0.05 * 0.05);
}

// Half of the landforms lie in clusters, and the other half anywhere: counts in cells vary by more than
// chance, and the share far from all clusters is that of the others.
TEST(PopulationPlaces, ClustersTakeTheirShare) {
  const BareSurface surface = ball_surface();
  Population population = counted(4000);
  population.clusters = Clusters{1, 0.05, 0.25};
  const auto landforms = draw_population(population, surface, 6, 0, "r");
  Population all = population;
  all.clusters->share = 1.0;
  Vec3d center;
  for (const DrawnLandform& f : draw_population(all, surface, 6, 0, "r")) center += f.position;
  center = normalized(center);
  const auto near = std::count_if(landforms.begin(), landforms.end(),
                                  [&](const DrawnLandform& f) { return norm(f.position - center) < 0.25; });
  const double by_chance = 0.75 * 4000.0 * 0.25 * 0.25 / 4.0;  // a cap's share is its chord squared over 4
  EXPECT_NEAR(static_cast<double>(near), 1000.0 + by_chance, 4.0 * std::sqrt(4000.0 * 0.25 * 0.75));
}

// The quantiles of the drawn sizes are uniform (Kolmogorov and Smirnov), and the likelihood of a shape is
// greatest near the true one.
TEST(PopulationPlaces, WeibullSizesAreRecovered) {
  const BareSurface surface = ball_surface();
  for (const double shape : {0.33, 0.8, 2.0}) {
    Population population = counted(5000);
    population.least_diameter = 0.05;
    population.greatest_diameter = 3.0;
    population.weibull = WeibullSizes{0.6, shape};
    std::vector<double> shares, diameters;
    for (const DrawnLandform& f : draw_population(population, surface, 3, 0, "r")) {
      ASSERT_TRUE(f.diameter >= 0.05 * (1 - 1e-9) && f.diameter <= 3.0);
      shares.push_back(share_below(population, f.diameter));
      diameters.push_back(f.diameter);
    }
    std::sort(shares.begin(), shares.end());
    double distance = 0.0;
    for (std::size_t i = 0; i < shares.size(); ++i) {
      distance = std::max(distance, std::fabs(shares[i] - (static_cast<double>(i) + 0.5) / 5000.0));
    }
    EXPECT_LT(distance, 1.95 / std::sqrt(5000.0)) << shape;
    const auto likelihood = [&](double k) {
      const auto fall = [&](double d) { return std::pow(d / 0.6, k); };
      const double whole = std::exp(-fall(0.05)) - std::exp(-fall(3.0));
      double sum = 0.0;
      for (const double d : diameters) sum += std::log(k / 0.6) + (k - 1) * std::log(d / 0.6) - fall(d);
      return sum - 5000.0 * std::log(whole);
    };
    EXPECT_GT(likelihood(shape), likelihood(1.15 * shape)) << shape;
    EXPECT_GT(likelihood(shape), likelihood(shape / 1.15)) << shape;
  }
}

TEST(PopulationPlaces, QuantilesAndSharesAreInverse) {
  for (const bool weibull : {false, true}) {
    Population population = sizes_between(0.1, 8.0, 2.65);
    if (weibull) population.weibull = WeibullSizes{0.004, 0.33};
    for (const double u : {-3.0, -0.1, 0.0, 0.2, 0.7, 0.999}) {
      EXPECT_NEAR(share_below(population, diameter_at(population, u)), u, 1e-9 * (1.0 + std::fabs(u)));
    }
    EXPECT_EQ(share_below(population, 9.0), 1.0);
  }
}

Population by_cells(double density, double least, double greatest, double exponent) {
  Population population = sizes_between(least, greatest, exponent);
  population.density = density;
  population.by_cells = true;
  return population;
}

TEST(PopulationByCells, HasItsDensityEverywhere) {
  const BareSurface surface = ball_surface();
  const double number = 1600.0 * 4.0 * std::numbers::pi;
  const auto landforms = draw_population(by_cells(1600.0, 0.004, 0.06, 2.0), surface, 2, 0, "r");
  EXPECT_NEAR(static_cast<double>(landforms.size()), number, 4.0 * std::sqrt(number));
  std::vector<double> cells(kBands * 24);
  for (const DrawnLandform& f : landforms) {
    ASSERT_NEAR(norm(f.position), 1.0, 1e-5);
    const int band = std::clamp(static_cast<int>(0.5 * (f.position.z + 1.0) * kBands), 0, kBands - 1);
    const double turn = std::atan2(f.position.y, f.position.x) / (2.0 * std::numbers::pi) + 0.5;
    ++cells[static_cast<std::size_t>(band * 24 + static_cast<int>(turn * 24) % 24)];
  }
  const std::vector<double> expected(cells.size(), number / static_cast<double>(cells.size()));
  EXPECT_LT(chi_squared(cells, expected), chi_limit(static_cast<int>(cells.size()) - 1));
}

// The exponent by maximum likelihood, of sizes so far apart that the truncation does not matter.
TEST(PopulationByCells, HasItsExponent) {
  const BareSurface surface = ball_surface();
  for (const double exponent : {2.0, 2.9}) {
    double sum = 0.0, n = 0.0;
    for (const DrawnLandform& f :
         draw_population(by_cells(1000.0, 0.0005, 0.0625, exponent), surface, 4, 0, "r")) {
      ASSERT_TRUE(f.diameter >= 0.0005 && f.diameter <= 0.0625);
      sum += std::log(f.diameter / 0.0005);
      ++n;
    }
    EXPECT_NEAR(n / sum, exponent, 4.0 * exponent / std::sqrt(n) + 2e-3) << n;
  }
}

// A layer draws its sizes, its places and its clusters from three streams. The keys of these streams may not
// meet those of a layer with another seed: here the places of one have the numbers of another's sizes if a
// key is the sum of a purpose and the layer.
TEST(PopulationPlaces, LayersWithSeedsShareNoNumbers) {
  const BareSurface surface = ball_surface();
  const PlaceWeight everywhere = [](const Vec3d&) { return 1.0f; };
  surface.area();
  for (const int apart : {199936, 218430208 - 199936, 218430208}) {
    const auto drawn = [&](int layer_seed) {
      return draw_population(counted(50), surface, 3, layer_number(layer_seed, 0), "r", {everywhere});
    };
    const auto one = drawn(77), other = drawn(77 + apart);
    ASSERT_EQ(one.size(), other.size());
    for (std::size_t i = 0; i < one.size(); ++i) {
      CounterRandom size_random = one[i].random;
      const double u = share_below(counted(1), one[i].diameter), v = size_random.uniform(),
                   w = size_random.uniform();
      EXPECT_GT(norm(surface.place({u, v, w}) - other[i].position), 1e-6) << apart;
    }
  }
}

TEST(PopulationByCells, FollowsTheWeight) {
  const BareSurface surface = ball_surface();
  const auto landforms =
      draw_population(by_cells(5000.0, 0.004, 0.03, 2.0), surface, 3, 0, "r", {northern_weight});
  expect_northern(landforms, 5000.0 * 4.0 * std::numbers::pi);
}

bool same(const DrawnLandform& a, const DrawnLandform& b) {
  return a.position == b.position && a.diameter == b.diameter &&
         CounterRandom(a.random).next() == CounterRandom(b.random).next();
}

// Layers lift the ground along normals: a small region far above the bare surface is not that of all ground
// within its height.
TEST(PopulationByCells, LiftedRegionsDrawWhatLiesBelowThem) {
  const BareSurface surface = ball_surface();
  const Population population = by_cells(3000.0, 0.003, 0.05, 2.2);
  const double lift = 0.4;
  const Vec3d center = (1.0 + lift) * normalized(Vec3d{0.3, -0.5, 0.8});
  DrawingPlaces places;
  places.margin = lift;
  places.region = widened(Box{center, center}, 0.05);
  const auto some = draw_population(population, surface, 7, 2, "r", places);
  std::size_t needed = 0, found = 0;
  for (const DrawnLandform& f : draw_population(population, surface, 7, 2, "r")) {
    const Vec3d lifted = (1.0 + lift) * f.position;
    if (!boxes_touch(widened(*places.region, 0.5 * f.diameter), {lifted, lifted})) continue;
    ++needed;
    for (const DrawnLandform& other : some) found += same(f, other) ? 1 : 0;
  }
  EXPECT_GT(needed, 5u);
  EXPECT_EQ(found, needed);
  EXPECT_LT(some.size(), 40 * needed);
}

// A region draws exactly the landforms of the whole body that matter to it, in their order.
TEST(PopulationByCells, RegionsDrawTheirOwn) {
  const BareSurface surface = ball_surface();
  const Population population = by_cells(3000.0, 0.003, 0.05, 2.2);
  const auto all = draw_population(population, surface, 7, 2, "r");
  const Vec3d center = normalized(Vec3d{0.3, -0.5, 0.8});
  DrawingPlaces places;
  places.region = widened(Box{center, center}, 0.1);
  const auto some = draw_population(population, surface, 7, 2, "r", places);
  ASSERT_GT(some.size(), 20u);
  ASSERT_LT(some.size(), all.size() / 5);
  std::size_t next = 0;
  for (const DrawnLandform& f : all) {
    if (next < some.size() && same(f, some[next])) {
      ++next;
      continue;
    }
    EXPECT_FALSE(boxes_touch(*places.region, {f.position, f.position}));
  }
  EXPECT_EQ(next, some.size());
}

TEST(PopulationByCells, FinerSizesChangeNoCoarserOnes) {
  const BareSurface surface = ball_surface();
  const Population coarse = by_cells(1000.0, 0.011, 0.05, 2.0);
  Population fine = coarse;
  fine.least_diameter = 0.003;
  fine.density = 1000.0 * share_below(coarse, 1.0) / (1.0 - share_below(fine, 0.011));
  const auto few = draw_population(coarse, surface, 7, 2, "r");
  auto many = draw_population(fine, surface, 7, 2, "r");
  std::erase_if(many, [](const DrawnLandform& f) { return f.diameter < 0.011; });
  ASSERT_EQ(few.size(), many.size());
  for (std::size_t i = 0; i < few.size(); ++i) {
    EXPECT_EQ(few[i].position, many[i].position);
    EXPECT_NEAR(few[i].diameter, many[i].diameter, 1e-9);
  }
}

// A whole body gets the largest 2e5 landforms at most, and says what it lacks.
TEST(PopulationByCells, WholeBodiesLeaveOutTheFinest) {
  const BareSurface surface = ball_surface();
  const Population population = by_cells(1e5, 0.001, 0.03, 3.0);
  const SizesByCells whole = sizes_by_cells(population, surface, true);
  const auto landforms = draw_population(population, surface, 1, 0, "r");
  const double number = 4e5 * std::numbers::pi;
  EXPECT_LT(landforms.size(), 201000u);
  EXPECT_NEAR(static_cast<double>(landforms.size()) + whole.number_left_out, number, 4000.0);
  for (const DrawnLandform& f : landforms) ASSERT_GE(f.diameter, whole.least);
  EXPECT_GT(whole.share_left_out, 0.0);
  EXPECT_EQ(sizes_by_cells(population, surface, false).number_left_out, 0.0);
  Population finer = population;
  finer.least_diameter = 1e-7;
  EXPECT_GT(sizes_by_cells(finer, surface, false).least, 0x1p-20);
}

TEST(PopulationByCells, LargeLandformsAreRefused) {
  const BareSurface surface = ball_surface();
  EXPECT_THROW(draw_population(by_cells(1.0, 0.01, 0.1, 2.0), surface, 1, 0, "r"), InputError);
}

}  // namespace
}  // namespace astrolith
