// Light of whole bodies against closed forms.
#include "synthesis/picture/phase_curve.h"

#include <cmath>
#include <numbers>

#include "gtest/gtest.h"
#include "numerics/parallel_for.h"
#include "tests/support/meshes.h"

namespace astrolith {
namespace {

constexpr double kPi = std::numbers::pi, kDegree = kPi / 180.0;

Vec3d direction(double degrees) { return {std::cos(degrees * kDegree), std::sin(degrees * kDegree), 0.0}; }

DiskOptions white_law(const std::string& words) { return {parse_reflectance("law", words), 1.0}; }

TEST(DiskLight, SpheresFollowLambertAndLommelSeeliger) {
  const TriangleMesh sphere = testing::icosphere(6, 2.0);
  for (const double phase : {0.0, 10.0, 45.0, 90.0, 130.0}) {
    const double a = phase * kDegree, disk = kPi * 4.0;
    const double lambert = 2.0 / 3.0 * (std::sin(a) + (kPi - a) * std::cos(a)) / kPi;
    EXPECT_NEAR(disk_light(sphere, white_law("lambert"), direction(phase), direction(0)) / disk, lambert,
                1e-3);
    const double seeliger =
        phase > 0.0 ? 1.0 - std::sin(a / 2) * std::tan(a / 2) * std::log(1.0 / std::tan(a / 4)) : 1.0;
    EXPECT_NEAR(disk_light(sphere, white_law("lommel-seeliger"), direction(phase), direction(0)) / disk,
                seeliger, 1e-3);
  }
}

// A white sphere sends back all light: twice the integral of the phase curve times sin is 3/2 of Lambert's.
TEST(DiskLight, AWhiteSphereSendsBackAllLight) {
  const TriangleMesh sphere = testing::icosphere(5, 1.0);
  double sum = 0.0;
  constexpr int kSteps = 90;
  for (int k = 0; k < kSteps; ++k) {
    const double phase = 180.0 * (k + 0.5) / kSteps;
    sum += 2.0 * disk_light(sphere, white_law("lambert"), direction(phase), direction(0)) / kPi *
           std::sin(phase * kDegree) * kPi / kSteps;
  }
  EXPECT_NEAR(sum, 1.0, 2e-3);
}

// Muinonen and Lumme, A&A 584, 2015: the ellipsoid of Lommel and Seeliger.
TEST(DiskLight, EllipsoidsFollowLommelSeeliger) {
  TriangleMesh ellipsoid = testing::icosphere(6, 1.0);
  const Vec3d half{3.0, 2.0, 1.0};
  for (Vec3d& v : ellipsoid.vertices) v = {v.x * half.x, v.y * half.y, v.z * half.z};
  for (const double phase : {20.0, 75.0, 120.0}) {
    const Vec3d sun = normalized(Vec3d{1.0, 0.4, 0.5});
    const Vec3d across = normalized(cross(sun, Vec3d{0.2, -1.0, 0.3}));
    const Vec3d viewer = std::cos(phase * kDegree) * sun + std::sin(phase * kDegree) * across;
    const auto scaled = [&](const Vec3d& v) { return Vec3d{v.x / half.x, v.y / half.y, v.z / half.z}; };
    const Vec3d s = scaled(sun), o = scaled(viewer);
    const double s0 = norm(s), s1 = norm(o), cosine = dot(s, o) / (s0 * s1),
                 sine = std::sqrt(1 - cosine * cosine);
    const double both = norm(s + o), alpha = std::atan2(sine, cosine);
    const double lambda = std::atan2(s1 * sine / both, (s0 + s1 * cosine) / both);
    const double bracket = std::cos(lambda - alpha) + std::cos(lambda) +
                           std::sin(lambda) * std::sin(lambda - alpha) *
                               std::log(1.0 / std::tan(lambda / 2) / std::tan((alpha - lambda) / 2));
    const double exact = kPi * half.x * half.y * half.z * s0 * s1 / both * bracket;
    EXPECT_NEAR(disk_light(ellipsoid, white_law("lommel-seeliger"), sun, viewer) / exact, 1.0, 2e-3);
  }
}

TEST(DiskLight, HasTheSameBitsForThreadsAndTurns) {
  TriangleMesh body = testing::icosphere(4, 1.0);
  for (Vec3d& v : body.vertices) v.x *= 2.0;
  const ThreadLimit one(1);
  const std::vector<double> light = light_curve(body, white_law("lambert"), 30.0, 4);
  EXPECT_NEAR(light[0], light[2], 1e-3);  // symmetric
  EXPECT_GT(light[1], 1.5 * light[0]);
  const std::vector<PhasePoint> curve = phase_curve(body, white_law("lambert"), {30.0});
  EXPECT_GT(curve[0].greatest, 1.5 * curve[0].least);
  const ThreadLimit two(2);
  EXPECT_EQ(light_curve(body, white_law("lambert"), 30.0, 4), light);
}

// The absolute magnitude of a sphere of 1 km and albedo .2 by Fowler and Chillemi (1992), 1329 km / D.
TEST(DiskLight, MagnitudesAreThoseOfTheUsualScale) {
  const double square_metres = 0.2 * kPi * 500.0 * 500.0;
  EXPECT_NEAR(reduced_magnitude(square_metres), 5.0 * std::log10(1329.0 / std::sqrt(0.2)), 0.02);
}

}  // namespace
}  // namespace astrolith
