#include <cmath>
#include <cstring>
#include <numbers>

#include "geometry/io/mesh_io.h"
#include "geometry/mesh_measure.h"
#include "gravity/facet_layer.h"
#include "gravity/polyhedron_gravity.h"
#include "numerics/errors.h"
#include "numerics/hash_random.h"
#include "numerics/parallel_for.h"
#include "tests/support/data.h"
#include "tests/support/meshes.h"

namespace astrolith {
namespace {

Attraction exact_at(const PolyhedronGravity& gravity, const Vec3d& p) {
  return gravity.exactly_at(std::vector<Vec3d>{p}).values[0];
}

double relative(const Vec3d& value, const Vec3d& truth) { return norm(value - truth) / norm(truth); }

// A rough body with hollows.
TriangleMesh rough_body(int subdivisions) {
  TriangleMesh mesh = testing::icosphere(subdivisions);
  for (Vec3d& p : mesh.vertices) {
    p = p * (1.0 + 0.2 * std::sin(4 * p.x + 1) * std::cos(3 * p.y) + 0.05 * std::sin(15 * p.z + 9 * p.x));
    p.x *= 2.0;
  }
  return mesh;
}

std::vector<Vec3d> facet_centers(const TriangleMesh& mesh) {
  std::vector<Vec3d> centers;
  for (const auto& [a, b, c] : mesh.triangles)
    centers.push_back((mesh.vertices[a] + mesh.vertices[b] + mesh.vertices[c]) * (1.0 / 3.0));
  return centers;
}

// On facets, edges and vertices the field is the limit of the field beside them.
TEST(PolyhedronGravity, ContinuousThroughTheSurface) {
  const TriangleMesh mesh = rough_body(2);
  const PolyhedronGravity gravity(mesh);
  for (std::size_t i = 0; i < mesh.triangles.size(); i += 17) {
    const auto& [ia, ib, ic] = mesh.triangles[i];
    const Vec3d &a = mesh.vertices[ia], &b = mesh.vertices[ib], &c = mesh.vertices[ic];
    for (const Vec3d& on : {a, b, 0.5 * (a + b), 0.25 * a + 0.75 * c, (a + b + c) * (1.0 / 3.0)}) {
      const Attraction value = exact_at(gravity, on);
      ASSERT_TRUE(std::isfinite(value.potential) && std::isfinite(norm(value.acceleration)));
      for (const double step : {1e-7, -1e-7, 1e-12}) {
        const Attraction beside = exact_at(gravity, on * (1.0 + step));
        EXPECT_NEAR(beside.potential, value.potential, 50 * std::fabs(step) + 1e-13);
        EXPECT_LT(norm(beside.acceleration - value.acceleration), 200 * std::fabs(step) + 1e-12);
      }
    }
  }
}

TEST(PolyhedronGravity, MultipolesKeepTheTolerance) {
  const TriangleMesh mesh = rough_body(5);
  const PolyhedronGravity gravity(mesh);
  std::vector<Vec3d> points;
  for (const Vec3d& p : facet_centers(mesh)) {
    if (points.size() < 3000) points.push_back(p);
  }
  for (int i = 0; i < 200; ++i) {
    const auto unit = [&](int k) { return unit_float(hash_cell(3u, i, k, 0)) - 0.5; };
    points.push_back(Vec3d{unit(0), unit(1), unit(2)} * (i % 2 == 0 ? 2.0 : 40.0));
  }
  const std::vector<Attraction> exact = gravity.exactly_at(points).values;
  for (const double tolerance : {1e-2, 1e-4, 1e-6, 1e-9}) {
    const std::vector<Attraction> values = gravity.at(points, tolerance);
    double worst = 0.0, worst_potential = 0.0;
    for (std::size_t i = 0; i < points.size(); ++i) {
      worst = std::max(worst, relative(values[i].acceleration, exact[i].acceleration));
      worst_potential = std::max(worst_potential, std::fabs(values[i].potential / exact[i].potential - 1));
    }
    EXPECT_LE(worst, tolerance) << tolerance;
    EXPECT_LE(worst_potential, tolerance) << tolerance;
    if (tolerance == 1e-2) {
      EXPECT_GT(worst, 1e-9);  // the tree was used
    }
  }
}

TEST(PolyhedronGravity, AchievedErrorIsThatOfTheSample) {
  const TriangleMesh mesh = rough_body(4);
  const PolyhedronGravity gravity(mesh);
  const std::vector<Vec3d> points = facet_centers(mesh);
  std::vector<Attraction> values = gravity.exactly_at(points).values;
  EXPECT_LT(achieved_error(gravity, points, values, 50, 1).largest, 1e-12);
  for (Attraction& value : values) value.acceleration *= 1.001;
  const AchievedError error = achieved_error(gravity, points, values, 50, 1);
  EXPECT_NEAR(error.largest, 1e-3, 1e-9);
  EXPECT_NEAR(error.rms, 1e-3, 1e-9);
  EXPECT_EQ(error.points, 50);
}

// Neither the size of a body nor its place changes anything but the unit.
TEST(PolyhedronGravity, ScalesAndShifts) {
  const TriangleMesh mesh = rough_body(3);
  TriangleMesh moved = mesh;
  for (Vec3d& p : moved.vertices) p = 1e4 * p + Vec3d{3e5, -2e5, 1e5};
  const Vec3d at{1.3, 0.2, -0.4};
  const Attraction a = PolyhedronGravity(mesh).at(std::vector<Vec3d>{at}, 1e-8)[0];
  const Attraction b =
      PolyhedronGravity(moved).at(std::vector<Vec3d>{1e4 * at + Vec3d{3e5, -2e5, 1e5}}, 1e-8)[0];
  EXPECT_NEAR(b.potential / (1e8 * a.potential), 1.0, 1e-8);
  EXPECT_LT(relative(b.acceleration, 1e4 * a.acceleration), 1e-7);
}

TEST(PolyhedronGravity, SameBitsForAnyThreads) {
  const TriangleMesh mesh = rough_body(4);
  const auto values = [&] { return PolyhedronGravity(mesh).at(facet_centers(mesh), 1e-5); };
  const std::vector<Attraction> many = values();
  const ThreadLimit limit(1);
  const std::vector<Attraction> one = values();
  EXPECT_EQ(std::memcmp(one.data(), many.data(), one.size() * sizeof(Attraction)), 0);
}

TEST(PolyhedronGravity, RefusesWhatHasNoSurfaceAndStops) {
  EXPECT_THROW(PolyhedronGravity{TriangleMesh{}}, InputError);
  EXPECT_THROW(PolyhedronGravity(TriangleMesh{{{0, 0, 0}, {1, 0, 0}, {2, 0, 0}}, {{0, 1, 2}}, {}}),
               InputError);
  const PolyhedronGravity cube(testing::cube());
  EXPECT_THROW(cube.at(std::vector<Vec3d>{{1, 2, 3}}, 1e-6, [](double, std::string_view) { return false; }),
               WorkError);
  EXPECT_TRUE(cube.at({}, 1e-6).empty());
}

// The benchmark gravity_peers.py compares with another program; here a random sample is compared with exact
// sums.
TEST(PolyhedronGravity, ErosWithinTheTolerance) {
  const auto file = testing::shared_shape("eros_gaskell_49k.ply");
  ASTROLITH_SKIP_WITHOUT(file);
  const TriangleMesh mesh = read_mesh(file);
  const PolyhedronGravity gravity(mesh);
  std::vector<Vec3d> points = facet_centers(mesh);
  points.resize(2000);
  const AchievedError error = achieved_error(gravity, points, gravity.at(points, 1e-6), 100, 1);
  EXPECT_LE(error.largest, 1e-6);
  EXPECT_LE(error.largest_of_potential, 1e-6);
}

// A square of side 2 seen from distance 1 above its centre: 4 (2 log((1 + sqrt 3) / sqrt 2) - pi / 6).
TEST(FacetLayer, PotentialOfASquare) {
  const double truth = 4 * (std::log(2 + std::sqrt(3.0)) - std::numbers::pi / 6);
  double sum = 0.0;
  for (const layer::Facet& f : {layer::make_facet({-1, -1, 0}, {1, -1, 0}, {1, 1, 0}),
                                layer::make_facet({-1, -1, 0}, {1, 1, 0}, {-1, 1, 0})}) {
    sum += layer::layer_potential(f, 0, 0, 1).potential;
  }
  EXPECT_NEAR(sum, truth, 1e-15 * 10);
}

// On the plane the layer of a right triangle with legs 1 at its right corner: sqrt(1/2) log(3 + 2 sqrt 2).
TEST(FacetLayer, AtACorner) {
  const layer::Facet f = layer::make_facet({0, 0, 0}, {1, 0, 0}, {0, 1, 0});
  const double truth = std::sqrt(0.5) * std::log(3 + 2 * std::sqrt(2.0));
  EXPECT_NEAR(layer::layer_potential(f, 0, 0, 0).potential, truth, 1e-15);
}

TEST(FacetLayer, NothingOfATriangleWithoutArea) {
  for (const layer::Facet& f : {layer::make_facet({0, 0, 0}, {1, 0, 0}, {2, 0, 0}),
                                layer::make_facet({1, 1, 1}, {1, 1, 1}, {1, 1, 1})}) {
    EXPECT_EQ(layer::layer_potential(f, 0.5, 0.0, 0.0).potential, 0.0);
    EXPECT_EQ(layer::layer_potential(f, 0.5, 1.0, 2.0).potential, 0.0);
  }
}

}  // namespace
}  // namespace astrolith
