#include <cmath>
#include <numbers>

#include "gravity/body_mass.h"
#include "gravity/polyhedron_gravity.h"
#include "gravity/surface_gravity.h"
#include "numerics/parallel_for.h"
#include "tests/support/meshes.h"

namespace astrolith {
namespace {

TriangleMesh box(const Vec3d& sides, const Vec3d& corner) {
  TriangleMesh mesh = testing::cube();
  for (Vec3d& p : mesh.vertices) p = Vec3d{p.x * sides.x, p.y * sides.y, p.z * sides.z} + corner;
  return mesh;
}

const GravityCoefficient& at(const std::vector<GravityCoefficient>& all, int l, int m) {
  return all[static_cast<std::size_t>(l * (l + 1) / 2 + m)];
}

TEST(BodyMass, MomentsOfABox) {
  const BodyMass body = body_mass(box({1, 2, 3}, {10, -20, 30}));
  EXPECT_NEAR(body.volume, 6.0, 1e-12);
  EXPECT_LT(norm(body.center - Vec3d{10.5, -19, 31.5}), 1e-12);
  EXPECT_NEAR(body.inertia[0][0], 6.0 * (4 + 9) / 12, 1e-12);
  EXPECT_NEAR(body.inertia[1][1], 6.0 * (1 + 9) / 12, 1e-12);
  EXPECT_NEAR(body.inertia[2][2], 6.0 * (1 + 4) / 12, 1e-12);
  EXPECT_NEAR(body.inertia[0][1], 0.0, 1e-12);
}

TEST(BodyMass, PrincipalAxesOfATurnedBox) {
  TriangleMesh mesh = box({3, 2, 1}, {-1.5, -1, -0.5});
  const Vec3d u = normalized(Vec3d{1, 2, 2}), v = normalized(cross(u, Vec3d{0, 0, 1})), w = cross(u, v);
  for (Vec3d& p : mesh.vertices) p = p.x * u + p.y * v + p.z * w;
  const PrincipalAxes axes = principal_axes(body_mass(mesh).inertia);
  EXPECT_NEAR(axes.moments[0], 6.0 * (4 + 1) / 12, 1e-12);
  EXPECT_NEAR(axes.moments[1], 6.0 * (9 + 1) / 12, 1e-12);
  EXPECT_NEAR(axes.moments[2], 6.0 * (9 + 4) / 12, 1e-12);
  EXPECT_NEAR(std::fabs(dot(axes.axes[0], u)), 1.0, 1e-12);
  EXPECT_NEAR(std::fabs(dot(axes.axes[2], w)), 1.0, 1e-12);
  EXPECT_NEAR(dot(cross(axes.axes[0], axes.axes[1]), axes.axes[2]), 1.0, 1e-12);
}

// Degree 2 follows from the moments of inertia (MacCullagh): C20 = (A + B - 2 C) / (2 M a^2 sqrt 5) and
// C22 = (B - A) / (4 M a^2) sqrt(12 / 5).
TEST(GravityCoefficients, DegreeTwoFollowsFromInertia) {
  const TriangleMesh mesh = box({1, 2, 3}, {-0.5, -1, -1.5});
  const auto all = gravity_coefficients(mesh, {}, 2.0, 2);
  const double a = 6.5, b = 5.0, c = 2.5, scale = 6.0 * 4.0;
  ASSERT_EQ(all.size(), 6u);
  EXPECT_DOUBLE_EQ(at(all, 0, 0).c, 1.0);
  EXPECT_NEAR(at(all, 1, 0).c, 0.0, 1e-15);
  EXPECT_NEAR(at(all, 2, 0).c, (a + b - 2 * c) / (2 * scale) / std::sqrt(5.0), 1e-14);
  EXPECT_NEAR(at(all, 2, 2).c, (b - a) / (4 * scale) * std::sqrt(12.0 / 5.0), 1e-14);
}

TEST(GravityCoefficients, AreTheSameForAnyThreadCount) {
  TriangleMesh mesh = testing::icosphere(4);
  for (Vec3d& p : mesh.vertices) p = {1.3 * p.x + 0.2 * p.y * p.z, p.y, 0.8 * p.z + 0.1 * p.x};
  std::vector<std::vector<GravityCoefficient>> by_threads;
  for (const int threads : {1, 16}) {
    const ThreadLimit limit(threads);
    by_threads.push_back(gravity_coefficients(mesh, {}, 1.7, 4));
  }
  for (std::size_t i = 0; i < by_threads[0].size(); ++i) {
    EXPECT_EQ(by_threads[0][i].c, by_threads[1][i].c) << i;
    EXPECT_EQ(by_threads[0][i].s, by_threads[1][i].s) << i;
  }
}

// The series outside the body is the exact potential.
TEST(GravityCoefficients, SeriesSumsToThePotential) {
  TriangleMesh mesh = testing::icosphere(2);
  for (Vec3d& p : mesh.vertices) p = {1.3 * p.x + 0.2 * p.y * p.z, p.y + 0.3, 0.8 * p.z + 0.1 * p.x};
  constexpr int kDegree = 24;
  const double radius = 1.7;
  const auto all = gravity_coefficients(mesh, {}, radius, kDegree);
  const double volume = body_mass(mesh).volume;
  const Vec3d p{3.5, -4.0, 3.0};
  const double r = norm(p), u = p.z / r, across = std::sqrt(1 - u * u), longitude = std::atan2(p.y, p.x);
  double sum = 0.0;
  for (int m = 0; m <= kDegree; ++m) {
    // Fully normalised Legendre functions by their recursion over degrees (Heiskanen & Moritz 1967).
    double sectoral = m == 0 ? 1.0 : std::sqrt(2.0);
    for (int k = 1; k <= m; ++k) sectoral *= across * std::sqrt((2.0 * k + 1) / (2.0 * k));
    double last = 0.0, now = sectoral;
    for (int l = m; l <= kDegree; ++l) {
      if (l > m) {
        const double f = std::sqrt((4.0 * l * l - 1) / (double(l) * l - m * m));
        const double g =
            l - 1 > m ? std::sqrt((4.0 * (l - 1) * (l - 1) - 1) / (double(l - 1) * (l - 1) - m * m)) : 1.0;
        const double next = f * (u * now - last / g);
        last = now;
        now = next;
      }
      const GravityCoefficient& k = at(all, l, m);
      sum += std::pow(radius / r, l) * now * (k.c * std::cos(m * longitude) + k.s * std::sin(m * longitude));
    }
  }
  const double exact = PolyhedronGravity(mesh).exactly_at(std::vector<Vec3d>{p}).values[0].potential;
  EXPECT_NEAR(volume / r * sum / exact, 1.0, 1e-12);
}

using std::numbers::pi;

// A ball of 1 km and 2,000 kg/m3: the attraction at its surface for G times density = 1, in km.
const Attraction kAtSurface{4 * pi / 3, {-4 * pi / 3, 0, 0}};

TEST(SurfaceGravity, UnitsAndRotation) {
  Rotation rotation;
  rotation.rate = 1e-4;
  const std::vector<Vec3d> points{{1000, 0, 500}};
  const PointGravity g = point_gravity(points, std::vector<Attraction>{kAtSurface}, 2000, 1000, rotation)[0];
  const double gm = kGravitationalConstant * 2000 * 4 * pi / 3;
  EXPECT_NEAR(g.potential, -gm * 1e6, 1e-12);
  EXPECT_NEAR(g.acceleration.x, -gm * 1e3, 1e-15);
  EXPECT_NEAR(g.geopotential, -gm * 1e6 - 0.5 * 1e-8 * 1e6, 1e-12);
  EXPECT_NEAR(g.effective.x, -gm * 1e3 + 1e-8 * 1000, 1e-15);
  EXPECT_EQ(g.effective.z, 0.0);
}

TEST(SurfaceGravity, TurnsAboutAnAxisThroughItsCentre) {
  const Rotation rotation{{10, 20, 30}, normalized(Vec3d{1, 1, 0}), 2e-3};
  const std::vector<Vec3d> points{Vec3d{10, 20, 30} + 5.0 * Vec3d{1, 1, 0} + Vec3d{0, 0, 7}};
  const PointGravity g = point_gravity(points, std::vector<Attraction>(1), 1, 1, rotation)[0];
  EXPECT_NEAR(g.geopotential, -0.5 * 4e-6 * 49, 1e-18);
  EXPECT_NEAR(norm(g.effective - Vec3d{0, 0, 7 * 4e-6}), 0, 1e-18);
}

TEST(SurfaceGravity, Slopes) {
  EXPECT_NEAR(slope_degrees({0, 0, 1}, {0, 0, -2e-3}), 0.0, 1e-12);
  EXPECT_NEAR(slope_degrees({0, 0, 1}, {0, -1e-3, -1e-3}), 45.0, 1e-12);
  EXPECT_NEAR(slope_degrees({0, 0, 1}, {0, 0, 1e-3}), 180.0, 1e-12);
  EXPECT_EQ(slope_degrees({0, 0, 1}, {0, 0, 0}), 90.0);
}

TEST(SurfaceGravity, ElevationsAreAboutTheirMean) {
  std::vector<PointGravity> values(2);
  values[0].geopotential = -50, values[1].geopotential = -56;
  values[0].effective = {0, 0, -4e-3}, values[1].effective = {0, 0, -7e-3};
  const std::vector<double> areas{1.0, 2.0};
  const SurfaceMeans means = surface_means(values, areas);
  EXPECT_DOUBLE_EQ(means.geopotential, -54.0);
  EXPECT_DOUBLE_EQ(means.effective, 6e-3);
  EXPECT_NEAR(elevation(values[0], means), 4.0 / 6e-3, 1e-9);
  EXPECT_NEAR(elevation(values[1], means), -2.0 / 6e-3, 1e-9);
}

}  // namespace
}  // namespace astrolith
