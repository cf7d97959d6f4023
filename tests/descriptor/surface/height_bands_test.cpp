#include <algorithm>
#include <array>
#include <cmath>
#include <complex>
#include <vector>

#include "descriptor/surface/evened_surface.h"
#include "descriptor/surface/height_bands.h"
#include "descriptor/surface/surface_quantity.h"
#include "numerics/errors.h"
#include "numerics/hash_random.h"
#include "numerics/parallel_for.h"
#include "tests/descriptor/surface/rough_spheres.h"

namespace astrolith {
namespace {

using testing::icosphere;
using testing::WaveHeights;

// A unit sphere of 20,000 points: its radius is 37 edges, which all bands fit.
constexpr std::int64_t kPoints = 20000;
const double kRadius = std::sqrt(std::sqrt(3.0) * kPoints / (8 * std::numbers::pi));  // edges

HeightBands find_bands(const TriangleMesh& mesh, std::int64_t points = kPoints) {
  return height_bands(even_surface(mesh, points, 1));
}

// The real part of (x + i y)^l, an eigenfunction of the sphere's Laplacian for the value -l (l + 1).
double sectoral(int l, const Vec3d& p) {
  return std::pow(std::hypot(p.x, p.y), l) * std::cos(l * std::atan2(p.y, p.x));
}

// Its mean square over the sphere: half of the mean of sin^(2l), the product of 2k / (2k + 1).
double sectoral_rms(int l) {
  double square = 0.5;
  for (int k = 1; k <= l; ++k) square *= 2.0 * k / (2.0 * k + 1);
  return std::sqrt(square);
}

double kept(int l, double scale) {
  const double g = std::exp(-0.5 * l * (l + 1) * scale * scale / (kRadius * kRadius));
  return 1 - std::pow(1 - g, 3);
}

TEST(HeightBands, ARippleLiesInTheBandOfItsWavelength) {
  const double edge = 1 / kRadius;
  for (const auto& [degree, most] : {std::pair{60, 0}, {30, 1}, {15, 2}, {8, 3}}) {
    const double amplitude = 0.4 * edge;
    const HeightBands found = find_bands(
        testing::rough_sphere<6>([&, l = degree](const Vec3d& p) { return amplitude * sectoral(l, p); }));
    ASSERT_EQ(found.bands.size(), 4u);
    for (std::size_t k = 0; k < 4; ++k) {
      const double share = kept(degree, kBandScales[k]) - kept(degree, kBandScales[k + 1]);
      // Low degrees also change the sphere's shape.
      EXPECT_NEAR(found.bands[k].rms / (0.4 * sectoral_rms(degree)), share, degree > 10 ? 0.06 : 0.1)
          << degree << " " << k;
      if (static_cast<int>(k) != most) {
        EXPECT_LT(found.bands[k].rms, found.bands[static_cast<std::size_t>(most)].rms) << degree << " " << k;
      }
    }
  }
}

TEST(HeightBands, ASphereHasNoRelief) {
  const HeightBands found = find_bands(icosphere(6));
  for (const HeightBand& band : found.bands) EXPECT_LT(band.rms, 0.006) << band.from;
}

TEST(HeightBands, SizeAndPlaceDoNotMatter) {
  const WaveHeights waves(0.2, 1);
  TriangleMesh mesh = testing::rough_sphere<6>([&](const Vec3d& p) { return 0.01 * waves(p); });
  const HeightBands one = find_bands(mesh);
  for (Vec3d& p : mesh.vertices) p = 1000 * p + Vec3d{3000, 200, 10};
  const HeightBands large = find_bands(mesh);
  for (std::size_t k = 0; k < 4; ++k)
    EXPECT_NEAR(large.bands[k].rms, one.bands[k].rms, 1e-3 * one.bands[k].rms);
  EXPECT_NEAR(*large.coupling, *one.coupling, 5e-3);
}

// Heights of rms about 1 whose waves along the sphere all have one length: sectoral harmonics of one degree
// about random axes.
class HarmonicHeights {
 public:
  HarmonicHeights(int degree, std::uint64_t seed) : degree_(degree) {
    for (std::uint64_t k = 0; k < kAxes; ++k) {
      CounterRandom random(seed, k);
      const Vec3d u = testing::random_direction(random);
      axes_.emplace_back(u, normalized(cross(u, testing::random_direction(random))));
    }
  }
  double operator()(const Vec3d& p) const {
    double sum = 0;
    for (const auto& [u, v] : axes_) sum += std::pow(std::complex(dot(u, p), dot(v, p)), degree_).real();
    return sum / (std::sqrt(1.0 * kAxes) * sectoral_rms(degree_));
  }

 private:
  static constexpr int kAxes = 60;
  int degree_;
  std::vector<std::pair<Vec3d, Vec3d>> axes_;
};

// Waves of 13 and of 36 edges, each high on one half of the sphere.
TEST(HeightBands, AreCoupledWhereTheyAreHighTogether) {
  const HarmonicHeights shorter(18, 1), longer(6, 2);
  const auto half = [](double along) { return 0.6 + 0.4 * std::clamp(3 * along, -1.0, 1.0); };
  const auto coupling = [&](const auto& where_longer) {
    return *find_bands(testing::rough_sphere<6>([&](const Vec3d& p) {
              return 0.007 * (where_longer(p) * longer(p) + half(p.z) * shorter(p));
            })).coupling;
  };
  EXPECT_GT(coupling([&](const Vec3d& p) { return half(p.z); }), 0.3);
  EXPECT_NEAR(coupling([&](const Vec3d& p) { return half(p.x); }), 0, 0.2);
  EXPECT_LT(coupling([&](const Vec3d& p) { return half(-p.z); }), -0.2);
}

// Creases crowd the points that look the same way.
TEST(HeightBands, OfACrumpledMeshAreBounded) {
  TriangleMesh mesh = icosphere(4);
  CounterRandom random(1, 0);
  for (Vec3d& p : mesh.vertices) p *= 1 + 0.4 * random.uniform();
  const HeightBands found = find_bands(mesh, 5000);
  ASSERT_EQ(found.bands.size(), 3u);
  for (const HeightBand& band : found.bands) EXPECT_LT(band.rms, 3) << band.from;
}

TEST(HeightBands, ASmallBodyHasFewer) {
  EXPECT_EQ(find_bands(icosphere(4), 2500).bands.size(), 2u);  // radius 13 edges
  EXPECT_FALSE(find_bands(icosphere(4), 2500).coupling);
}

TEST(HeightBands, AreTheSameForAnyNumberOfThreads) {
  const WaveHeights waves(0.2, 1);
  const TriangleMesh mesh = testing::rough_sphere<6>([&](const Vec3d& p) { return 0.01 * waves(p); });
  const auto measured = [&](int threads) {
    const ThreadLimit limit(threads);
    return find_bands(mesh);
  };
  const HeightBands one = measured(1), four = measured(4);
  for (std::size_t k = 0; k < 4; ++k) EXPECT_EQ(one.bands[k].rms, four.bands[k].rms);
  EXPECT_EQ(one.coupling, four.coupling);
}

TEST(HeightBands, StopWhenAsked) {
  const EvenedSurface even = even_surface(icosphere(4), 3000, 1);
  EXPECT_THROW(height_bands(even, [](double, std::string_view) { return false; }), WorkError);
}

using testing::sheet;

TEST(EvenedSurface, StaysOnASphere) {
  const EvenedSurface even = even_surface(icosphere(5), 4000, 1);
  ASSERT_EQ(even.points.size(), 4000u);
  EXPECT_NEAR(even.edge, std::sqrt(2 * 4 * std::numbers::pi / (std::sqrt(3.0) * 4000)), 1e-3 * even.edge);
  for (std::size_t i = 0; i < even.points.size(); ++i) {
    // A smoothed sphere shrinks by about rho^2 / 20, with rho the reach of the weights.
    EXPECT_NEAR(norm(even.points[i]), 1, 2 * even.edge * even.edge);
    EXPECT_GT(dot(even.normals[i], normalized(even.points[i])), 0.999);
  }
}

// The weights (1 - d^2 / rho^2)^3 over a plane let through 384 J4(x) / x^4 of a wave's height, x = k rho
// (Sonine's first integral).
TEST(EvenedSurface, LetsThroughAsMuchOfAWaveAsItsWeightsDo) {
  const double wave = 10, k = 2 * std::numbers::pi / wave;
  const TriangleMesh mesh = sheet(80, [&](double x, double) { return 0.1 * std::cos(k * x); });
  const EvenedSurface even = even_surface(mesh, 6400, 1);
  const double x = k * 3.5 * even.edge, expected = 384 * std::cyl_bessel_j(4, x) / (x * x * x * x),
               between = std::sin(k / 2) / (k / 2);  // straight lines between vertices take their share, too
  double along = 0, all = 0;
  for (const Vec3d& p : even.points) {
    if (std::min({p.x, p.y, 80 - p.x, 80 - p.y}) < 5) continue;
    along += p.z * std::cos(k * p.x);
    all += std::cos(k * p.x) * std::cos(k * p.x);
  }
  EXPECT_NEAR(along / all / 0.1, expected * between * between, 0.02 * expected);
}

TEST(EvenedSurface, OtherSideOfAThinPlateDoesNotCount) {
  TriangleMesh plate = sheet(40, [](double, double) { return 0.1; });
  plate = testing::joined(plate, testing::reversed(sheet(40, [](double, double) { return -0.1; })));
  for (const Vec3d& p : even_surface(plate, 3000, 1).points) ASSERT_NEAR(std::fabs(p.z), 0.1, 1e-12);
}

// The area of a mesh whose vertices were exchanged is hundreds of times that of its box.
TEST(EvenedSurface, AGarbledMeshIsNoSurface) {
  TriangleMesh mesh = icosphere(6);
  CounterRandom random(5);
  for (Triangle& t : mesh.triangles) {
    for (std::uint32_t& v : t) {
      v = static_cast<std::uint32_t>(random.uniform() * static_cast<double>(mesh.vertices.size()));
    }
  }
  EXPECT_THROW(even_surface(mesh, 20000, 1), InputError);
}

TEST(EvenedSurface, StopsWhenAsked) {
  EXPECT_THROW(even_surface(icosphere(4), 2000, 1, [](double, std::string_view) { return false; }),
               WorkError);
}

std::vector<Vec3d> sample_points(const LocalQuadric& quadric, int n, double noise, std::uint64_t seed) {
  CounterRandom random(seed, 0);
  std::vector<Vec3d> points;
  for (int i = 0; i < n; ++i) {
    const double x = random.uniform(-1, 1), y = random.uniform(-1, 1);
    points.push_back({x, y, quadric.height(x, y) + noise * random.normal()});
  }
  return points;
}

const LocalQuadric kQuadric{{0.3, -0.2, 0.1, 0.5, -0.7, 0.25}};

TEST(LocalQuadric, FindsAParaboloidExactly) {
  const auto fitted = fit_quadric(sample_points(kQuadric, 40, 0, 1));
  ASSERT_TRUE(fitted);
  for (std::size_t k = 0; k < 6; ++k) EXPECT_NEAR(fitted->c[k], kQuadric.c[k], 1e-13);
}

TEST(LocalQuadric, NormalStandsOnTheSurface) {
  const double h = 1e-6;
  const Vec3d n = kQuadric.normal(0.4, -0.3);
  const double z = kQuadric.height(0.4, -0.3);
  EXPECT_NEAR(dot(n, Vec3d{h, 0, kQuadric.height(0.4 + h, -0.3) - z}), 0, 1e-11);
  EXPECT_NEAR(dot(n, Vec3d{0, h, kQuadric.height(0.4, -0.3 + h) - z}), 0, 1e-11);
  EXPECT_NEAR(norm(n), 1, 1e-15);
}

TEST(LocalQuadric, HasNoneWherePointsDoNotDetermineIt) {
  std::vector<Vec3d> line;
  for (int i = 0; i < 30; ++i) line.push_back({0.05 * i, 0.1 * i, 0.0});
  EXPECT_FALSE(fit_quadric(line));
  EXPECT_FALSE(fit_quadric(sample_points(kQuadric, 5, 0, 2)));
}

TEST(ResidualMoments, RmsOfKnownNoiseIsUnbiased) {
  double mean_square = 0;
  const int trials = 400, n = 20;
  for (int t = 0; t < trials; ++t) {
    const auto points = sample_points(kQuadric, n, 0.1, static_cast<std::uint64_t>(10 + t));
    const auto fitted = fit_quadric(points);
    ASSERT_TRUE(fitted);
    std::vector<double> residuals;
    for (const Vec3d& p : points) residuals.push_back(p.z - fitted->height(p.x, p.y));
    const double rms = residual_moments(residuals, 1e-9).rms;
    mean_square += rms * rms / trials;
  }
  EXPECT_NEAR(mean_square, 0.01, 4 * 0.01 * std::sqrt(2.0 / (14 * trials)));
}

TEST(ResidualMoments, FollowTheirDefinition) {
  // Two values: skewness (1 - 2p) / sqrt(p (1 - p)), kurtosis 1 / (p (1 - p)) - 6, for a share p of the
  // upper.
  std::vector<double> values(100, -0.1);
  for (std::size_t i = 0; i < 10; ++i) values[i] = 0.9;
  const ResidualMoments m = residual_moments(values, 1e-9);
  EXPECT_NEAR(m.skewness, 0.8 / 0.3, 1e-12);
  EXPECT_NEAR(m.kurtosis, 1 / 0.09 - 6, 1e-12);
  EXPECT_NEAR(m.rms, std::sqrt(9.0 / 94), 1e-14);
  for (double& v : values) v = -v;
  EXPECT_NEAR(residual_moments(values, 1e-9).skewness, -0.8 / 0.3, 1e-12);
  EXPECT_EQ(residual_moments(values, 10).skewness, 0);
}

}  // namespace
}  // namespace astrolith
