#include "descriptor/surface/surface_statistics.h"

#include "numerics/errors.h"
#include "numerics/parallel_for.h"
#include "tests/descriptor/surface/rough_spheres.h"

namespace astrolith {
namespace {

using testing::BumpHeights;
using testing::icosphere;
using testing::mean_value;
using testing::rough_sphere;
using testing::sheet;
using testing::WaveHeights;

constexpr double kEdge = 0.0376;  // of the spheres

SurfaceStatisticsOptions few_places() {
  SurfaceStatisticsOptions options;
  options.places = 800;
  return options;
}

double mean_value(const SurfaceStatistics& s, SurfaceQuantity quantity, double radius) {
  return mean_value(s.find(quantity, radius)->values);
}

TEST(SurfaceStatistics, ASphereIsSmoothAndLevel) {
  const SurfaceStatistics s = surface_statistics(icosphere(5), few_places());
  EXPECT_EQ(s.points, 10240);
  EXPECT_EQ(s.places.size(), 800u);
  EXPECT_NEAR(s.edge, kEdge, 0.0005);
  EXPECT_LT(mean_value(s, SurfaceQuantity::roughness, 3), std::log(1e-3));
  EXPECT_LT(mean_value(s, SurfaceQuantity::normals, 3), 0.5);
  EXPECT_LT(mean_value(s, SurfaceQuantity::slope, 0), 1);
  ASSERT_EQ(s.remarks.size(), 1u);  // 24 edges are .9 of the radius
  EXPECT_EQ(s.find(SurfaceQuantity::roughness, 24), nullptr);
}

// In a disc of many waves a quadric takes hardly anything of a wave of amplitude a, whose rms is a / sqrt 2
// times what the evening lets through.
TEST(SurfaceStatistics, RoughnessOfAWaveIsItsAmplitude) {
  const double wave = 8, k = 2 * std::numbers::pi / wave, amplitude = 0.2;
  const SurfaceStatistics s =
      surface_statistics(sheet(100, [&](double x, double) { return amplitude * std::cos(k * x); }), {});
  const double x = k * 3.5 * s.edge, through = 384 * std::cyl_bessel_j(4, x) / (x * x * x * x);
  std::vector<double> rms;
  for (std::size_t i = 0; i < s.places.size(); ++i) {
    const Vec3d& p = s.places[i];
    if (std::min({p.x, p.y, 100 - p.x, 100 - p.y}) < 14) continue;
    rms.push_back(12 * s.edge * std::exp(s.find(SurfaceQuantity::roughness, 12)->values[i]));
  }
  EXPECT_NEAR(mean_value(rms), amplitude * through / std::sqrt(2.0), 0.03 * amplitude);
  // A sheet holds no volume, so that slopes have no vertical; discs of 24 edges are as large as the sheet.
  EXPECT_EQ(s.find(SurfaceQuantity::slope, 0), nullptr);
  EXPECT_EQ(s.remarks.size(), 2u);
}

TEST(SurfaceStatistics, TwiceTheHeightIsTwiceAsRough) {
  const WaveHeights waves(6 * kEdge, 1);
  const auto one = surface_statistics(rough_sphere([&](const Vec3d&p) { return 0.004 * waves(p); }),
                                      few_places()),
             two = surface_statistics(rough_sphere([&](const Vec3d&p) { return 0.008 * waves(p); }),
                                      few_places());
  for (const double radius : {3.0, 6.0, 12.0}) {
    EXPECT_NEAR(mean_value(two, SurfaceQuantity::roughness, radius) -
                    mean_value(one, SurfaceQuantity::roughness, radius),
                std::log(2.0), 0.05);
    EXPECT_NEAR(mean_value(one, SurfaceQuantity::skewness, radius), 0, 0.06);
  }
  EXPECT_GT(mean_value(two, SurfaceQuantity::slope, 0), 1.7 * mean_value(one, SurfaceQuantity::slope, 0));
  EXPECT_NEAR(two.lags[3].difference / one.lags[3].difference, 2, 0.1);
}

TEST(SurfaceStatistics, BumpsAreSkewedUpAndPitsDown) {
  const BumpHeights bumps(150, 1.2 * kEdge, 2);
  const auto up = surface_statistics(rough_sphere([&](const Vec3d&p) { return 0.03 * bumps(p); }),
                                     few_places()),
             down = surface_statistics(rough_sphere([&](const Vec3d&p) { return -0.03 * bumps(p); }),
                                       few_places());
  for (const double radius : {6.0, 12.0}) {
    EXPECT_GT(mean_value(up, SurfaceQuantity::skewness, radius), 0.4) << radius;
    EXPECT_LT(mean_value(down, SurfaceQuantity::skewness, radius), -0.4) << radius;
    EXPECT_GT(mean_value(up, SurfaceQuantity::kurtosis, radius), 0.5);
  }
}

TEST(SurfaceStatistics, RegionsOfTwoRoughnessesAreFound) {
  const WaveHeights waves(5 * kEdge, 3);
  const auto halves = surface_statistics(
                 rough_sphere([&](const Vec3d&p) { return (p.z > 0 ? 0.012 : 0.003) * waves(p); }),
                 few_places()),
             even = surface_statistics(rough_sphere([&](const Vec3d&p) { return 0.006 * waves(p); }),
                                       few_places());
  EXPECT_GT(halves.regions.correlation(1), 0.45);
  EXPECT_LT(std::fabs(even.regions.correlation(1)), 0.15);
  EXPECT_GT(halves.regions.between, 0.3);  // half the logarithm of 4, squared: .48
  EXPECT_LT(even.regions.between, 0.05);
}

TEST(SurfaceStatistics, SizeAndPlaceDoNotMatter) {
  const WaveHeights waves(5 * kEdge, 4);
  TriangleMesh mesh = rough_sphere([&](const Vec3d& p) { return 0.01 * waves(p); });
  const auto one = surface_statistics(mesh, few_places());
  for (Vec3d& p : mesh.vertices) p = 1024.0 * p;
  const auto large = surface_statistics(mesh, few_places());
  EXPECT_NEAR(large.edge, 1024 * one.edge, 1e-9 * large.edge);
  for (std::size_t s = 0; s < one.local.size(); ++s) {
    EXPECT_NEAR(mean_value(large.local[s].values), mean_value(one.local[s].values), 1e-6);
  }
}

TEST(SurfaceStatistics, HardlyDependOnTheTriangulation) {
  const WaveHeights waves(8 * kEdge, 5);
  const auto height = [&](const Vec3d& p) { return 0.01 * waves(p); };
  TriangleMesh fine = icosphere(6);
  for (Vec3d& p : fine.vertices) p *= 1 + height(p);
  SurfaceStatisticsOptions options = few_places();
  options.points = 10240;
  const auto a = surface_statistics(rough_sphere(height), options), b = surface_statistics(fine, options);
  for (const double radius : {3.0, 6.0, 12.0}) {
    EXPECT_NEAR(mean_value(a, SurfaceQuantity::roughness, radius),
                mean_value(b, SurfaceQuantity::roughness, radius), 0.05);
  }
}

TEST(SurfaceStatistics, AreTheSameForAnyNumberOfThreads) {
  const WaveHeights waves(5 * kEdge, 6);
  const TriangleMesh mesh = rough_sphere([&](const Vec3d& p) { return 0.01 * waves(p); });
  const auto measured = [&](int threads) {
    const ThreadLimit limit(threads);
    return surface_statistics(mesh, few_places());
  };
  const SurfaceStatistics one = measured(1), four = measured(4);
  for (std::size_t s = 0; s < one.local.size(); ++s) EXPECT_EQ(one.local[s].values, four.local[s].values);
  EXPECT_EQ(one.regions.correlation(0), four.regions.correlation(0));
}

TEST(SurfaceStatistics, BadOptionsAndMeshesAreRefused) {
  const TriangleMesh mesh = icosphere(3);
  const auto refused = [&](auto change) {
    SurfaceStatisticsOptions options;
    change(options);
    EXPECT_THROW(surface_statistics(mesh, options), InputError);
  };
  refused([](auto& o) { o.points = 499; });
  refused([](auto& o) { o.points = 60001; });
  refused([](auto& o) { o.places = 99; });
  refused([](auto& o) { o.density = 0; });
  EXPECT_THROW(surface_statistics(testing::octahedron(), {}), InputError);
  EXPECT_THROW(surface_statistics(mesh, {}, [](double, std::string_view) { return false; }), WorkError);
}

}  // namespace
}  // namespace astrolith
