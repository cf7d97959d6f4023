#include "gravity/polyhedron_gravity.h"

#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <cstring>
#include <map>
#include <numbers>

#include "geometry/io/mesh_io.h"
#include "geometry/mesh_measure.h"
#include "numerics/errors.h"
#include "numerics/hash_random.h"
#include "numerics/parallel_for.h"
#include "tests/support/data.h"
#include "tests/support/meshes.h"

namespace astrolith {
namespace {

using std::numbers::pi;
using Long = long double;
using LongVector = Vec3<Long>;

Attraction exact_at(const PolyhedronGravity& gravity, const Vec3d& p) {
  return gravity.exactly_at(std::vector<Vec3d>{p})[0];
}

double relative(const Vec3d& value, const Vec3d& truth) { return norm(value - truth) / norm(truth); }

LongVector wide(const Vec3d& v) { return {v.x, v.y, v.z}; }

// The sums of Werner & Scheeres 1997 as printed, over edges and faces with dyads, in long double and by the C
// library: nothing is shared with the code under test.
Attraction werner_scheeres(const TriangleMesh& mesh, const Vec3d& point) {
  const LongVector p = wide(point);
  std::map<std::pair<std::uint32_t, std::uint32_t>, LongVector> normals;  // of the face left of an edge
  Long potential = 0;
  LongVector pull;
  const auto normal_of = [&](const Triangle& t) {
    const LongVector a = wide(mesh.vertices[t[0]]), b = wide(mesh.vertices[t[1]]),
                     c = wide(mesh.vertices[t[2]]);
    return normalized(cross(b - a, c - a));
  };
  for (const Triangle& t : mesh.triangles) {
    for (std::size_t k = 0; k < 3; ++k) normals[{t[k], t[(k + 1) % 3]}] = normal_of(t);
  }
  for (const auto& [edge, n] : normals) {
    if (edge.first > edge.second) continue;
    const LongVector a = wide(mesh.vertices[edge.first]), b = wide(mesh.vertices[edge.second]);
    const LongVector other = normals.at({edge.second, edge.first}), along = normalized(b - a), r = a - p;
    const LongVector out = cross(along, n), other_out = cross(other, along);
    const Long r1 = norm(a - p), r2 = norm(b - p), e = norm(b - a), l = logl((r1 + r2 + e) / (r1 + r2 - e));
    const LongVector dyad = n * dot(out, r) + other * dot(other_out, r);
    potential += l * dot(r, dyad);
    pull -= dyad * l;
  }
  for (const Triangle& t : mesh.triangles) {
    const LongVector a = wide(mesh.vertices[t[0]]) - p, b = wide(mesh.vertices[t[1]]) - p,
                     c = wide(mesh.vertices[t[2]]) - p, n = normal_of(t);
    const Long ra = norm(a), rb = norm(b), rc = norm(c);
    const Long solid =
        2 * atan2l(dot(a, cross(b, c)), ra * rb * rc + ra * dot(b, c) + rb * dot(c, a) + rc * dot(a, b));
    potential -= solid * dot(n, a) * dot(n, a);
    pull += n * (solid * dot(n, a));
  }
  return {static_cast<double>(potential / 2),
          {static_cast<double>(pull.x), static_cast<double>(pull.y), static_cast<double>(pull.z)}};
}

TriangleMesh ellipsoid(int subdivisions, const Vec3d& half_axes) {
  TriangleMesh mesh = testing::icosphere(subdivisions);
  for (Vec3d& p : mesh.vertices) p = {p.x * half_axes.x, p.y * half_axes.y, p.z * half_axes.z};
  return mesh;
}

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

TEST(PolyhedronGravity, ClosedFormsOfACube) {
  const PolyhedronGravity cube(testing::cube());
  const double corner_pull = 2 * std::log(1 + std::sqrt(2.0)) - std::log(2 + std::sqrt(3.0)) + pi / 6;
  const double center = 3 * std::log(2 + std::sqrt(3.0)) - pi / 2;
  EXPECT_NEAR(exact_at(cube, {0.5, 0.5, 0.5}).potential, center, 1e-14);
  EXPECT_LT(norm(exact_at(cube, {0.5, 0.5, 0.5}).acceleration), 1e-14);
  for (const Vec3d& corner : testing::cube().vertices) {
    const Attraction at = exact_at(cube, corner);
    EXPECT_NEAR(at.potential, center / 2, 1e-14);
    const Vec3d inward = Vec3d{1, 1, 1} - 2.0 * corner;
    EXPECT_LT(norm(at.acceleration - corner_pull * inward), 1e-14);
  }
}

TEST(PolyhedronGravity, AgreesWithThePrintedSumsInLongDouble) {
  const TriangleMesh mesh = ellipsoid(3, {3, 2, 1});
  const PolyhedronGravity gravity(mesh);
  for (const Vec3d& p : {Vec3d{0.1, 0.2, 0.3}, Vec3d{2.5, 0.3, -0.1}, Vec3d{3.001, 0.1, 0.2},
                         Vec3d{-1, 2.2, 0.7}, Vec3d{0, 0.4, -30}, Vec3d{9, 1, 4}}) {
    const Attraction truth = werner_scheeres(mesh, p), value = exact_at(gravity, p);
    EXPECT_NEAR(value.potential / truth.potential, 1.0, 1e-12);
    EXPECT_LT(relative(value.acceleration, truth.acceleration), 1e-11) << p.x;
  }
}

// Inscribed polyhedra approach a ball in proportion to the squares of their edges; the extrapolated values
// are those of the ball.
TEST(PolyhedronGravity, ApproachesABallInsideAndOutside) {
  const auto potential = [](int subdivisions, double at) {
    return exact_at(PolyhedronGravity(testing::icosphere(subdivisions)), Vec3d{0.6, 0.0, 0.8} * at).potential;
  };
  for (const double at : {0.3, 0.7, 1.5, 4.0}) {
    const double truth = at < 1.0 ? 2 * pi / 3 * (3 - at * at) : 4 * pi / 3 / at;
    const double coarse = potential(3, at), middle = potential(4, at), fine = potential(5, at);
    const double once = (4 * middle - coarse) / 3, again = (4 * fine - middle) / 3;
    EXPECT_NEAR((16 * again - once) / 15 / truth, 1.0, 1e-7) << at;
    EXPECT_NEAR((truth - coarse) / (truth - middle), 4.0, 0.1) << at;
  }
}

// Inside a homogeneous ellipsoid the pull along each axis grows linearly: 2 pi a b c A x, with A from a table
// of integrals (MacMillan 1930), here by a substitution and Simpson's rule.
TEST(PolyhedronGravity, ApproachesAnEllipsoidInside) {
  const Vec3d half{3, 2, 1};
  const auto factor = [&](double axis) {
    const auto f = [&](double t) {  // u = (t / (1 - t))^2
      const double u = t / (1 - t), square = u * u, all = (square + 9) * (square + 4) * (square + 1);
      return t < 1.0 ? 2 * u / ((1 - t) * (1 - t)) / ((square + axis * axis) * std::sqrt(all)) : 0.0;
    };
    double sum = 0.0;
    constexpr int kSteps = 20000;
    for (int i = 0; i < kSteps; ++i) {
      sum += f(double(i) / kSteps) + 4 * f((i + 0.5) / kSteps) + f(double(i + 1) / kSteps);
    }
    return sum / (6 * kSteps);
  };
  const Vec3d p{0.7, -0.5, 0.2};
  const Vec3d truth = -2 * pi * 6 * Vec3d{factor(half.x) * p.x, factor(half.y) * p.y, factor(half.z) * p.z};
  const auto pull = [&](int n) { return exact_at(PolyhedronGravity(ellipsoid(n, half)), p).acceleration; };
  const Vec3d coarse = pull(3), middle = pull(4), fine = pull(5);
  const Vec3d once = (4.0 * middle - coarse) * (1.0 / 3), again = (4.0 * fine - middle) * (1.0 / 3);
  EXPECT_LT(relative((16.0 * again - once) * (1.0 / 15), truth), 1e-6);
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
  const std::vector<Attraction> exact = gravity.exactly_at(points);
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
  std::vector<Attraction> values = gravity.exactly_at(points);
  EXPECT_EQ(achieved_error(gravity, points, values, 50, 1).largest, 0.0);
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

}  // namespace
}  // namespace astrolith
