#include "descriptor/surface/height_bands.h"

#include <algorithm>
#include <array>
#include <complex>

#include "numerics/errors.h"
#include "numerics/parallel_for.h"
#include "tests/descriptor/surface/rough_spheres.h"

namespace astrolith {
namespace {

using testing::icosphere;
using testing::WaveHeights;

// A unit sphere of 20,000 points: its radius is 37 edges, which all bands fit.
constexpr std::int64_t kPoints = 20000;
const double kRadius = std::sqrt(std::sqrt(3.0) * kPoints / (8 * std::numbers::pi));  // edges

HeightBands bands_of(const TriangleMesh& mesh, std::int64_t points = kPoints) {
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
    const HeightBands found = bands_of(
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
  const HeightBands found = bands_of(icosphere(6));
  for (const HeightBand& band : found.bands) EXPECT_LT(band.rms, 0.006) << band.from;
}

TEST(HeightBands, SizeAndPlaceDoNotMatter) {
  const WaveHeights waves(0.2, 1);
  TriangleMesh mesh = testing::rough_sphere<6>([&](const Vec3d& p) { return 0.01 * waves(p); });
  const HeightBands one = bands_of(mesh);
  for (Vec3d& p : mesh.vertices) p = 1000 * p + Vec3d{3000, 200, 10};
  const HeightBands large = bands_of(mesh);
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
    return *bands_of(testing::rough_sphere<6>([&](const Vec3d& p) {
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
  const HeightBands found = bands_of(mesh, 5000);
  ASSERT_EQ(found.bands.size(), 3u);
  for (const HeightBand& band : found.bands) EXPECT_LT(band.rms, 3) << band.from;
}

TEST(HeightBands, ASmallBodyHasFewer) {
  EXPECT_EQ(bands_of(icosphere(4), 2500).bands.size(), 2u);  // radius 13 edges
  EXPECT_FALSE(bands_of(icosphere(4), 2500).coupling);
}

TEST(HeightBands, AreTheSameForAnyNumberOfThreads) {
  const WaveHeights waves(0.2, 1);
  const TriangleMesh mesh = testing::rough_sphere<6>([&](const Vec3d& p) { return 0.01 * waves(p); });
  const auto measured = [&](int threads) {
    const ThreadLimit limit(threads);
    return bands_of(mesh);
  };
  const HeightBands one = measured(1), four = measured(4);
  for (std::size_t k = 0; k < 4; ++k) EXPECT_EQ(one.bands[k].rms, four.bands[k].rms);
  EXPECT_EQ(one.coupling, four.coupling);
}

TEST(HeightBands, StopWhenAsked) {
  const EvenedSurface even = even_surface(icosphere(4), 3000, 1);
  EXPECT_THROW(height_bands(even, [](double, std::string_view) { return false; }), WorkError);
}

}  // namespace
}  // namespace astrolith
