#include <algorithm>
#include <limits>
#include <numbers>

#include "geometry/mesh_measure.h"
#include "geometry/surface/surface_distance.h"
#include "geometry/surface/surface_tree.h"
#include "numerics/errors.h"
#include "numerics/hash_random.h"
#include "numerics/parallel_for.h"
#include "tests/support/meshes.h"
#include "tests/support/points.h"

namespace astrolith {
namespace {

using namespace testing;

// The first triangle with the least squared distance, found by trying all triangles.
ClosestPoint closest_by_force(const TriangleMesh& mesh, const Vec3d& p) {
  ClosestPoint best;
  double least = std::numeric_limits<double>::infinity();
  for (std::uint32_t t = 0; t < mesh.triangles.size(); ++t) {
    const auto [i, j, k] = mesh.triangles[t];
    const auto c = closest_on_triangle(p, mesh.vertices[i], mesh.vertices[j], mesh.vertices[k]);
    if (c.squared_distance >= least) continue;
    least = c.squared_distance;
    best = {c.point, t, std::sqrt(least), {}};
  }
  return best;
}

TEST(SurfaceTree, EqualsBruteForceToTheLastBit) {
  CounterRandom random(3);
  const Vec3d far{1e5, -3e5, 2e5};  // single precision alone would lose three digits here
  for (const TriangleMesh& mesh : {icosphere(3, 1, far), torus(1, 0.3), two_spheres(2, 1, 2.5), cube()}) {
    const SurfaceTree tree(mesh);
    const Vec3d center = mesh.bounds().center();
    for (int i = 0; i < 300; ++i) {
      const Vec3d p = center + random_point(random, cube_about_origin(2));
      const ClosestPoint found = tree.closest(p), truth = closest_by_force(mesh, p);
      ASSERT_EQ(found.distance, truth.distance);
      ASSERT_EQ(found.triangle, truth.triangle);
    }
  }
}

// At vertices and midpoints of edges of the mesh many triangles are equally near.
TEST(SurfaceTree, TiesGoToTheLowestTriangle) {
  const TriangleMesh mesh = icosphere(2);
  const SurfaceTree tree(mesh);
  for (const Vec3d& p : mesh.vertices) {
    for (const double radius : {0.5, 1.0, 1.5}) {
      ASSERT_EQ(tree.closest(radius * p).triangle, closest_by_force(mesh, radius * p).triangle);
    }
  }
}

// Boxes in single precision hold all triangles of a body that is tiny beside its mesh's box.
TEST(SurfaceTree, AGarbledMeshIsRefused) {
  TriangleMesh flung = icosphere(4);
  flung.vertices[7] = 1e9 * flung.vertices[7];
  EXPECT_THROW(SurfaceTree{flung}, InputError);
  TriangleMesh exchanged = icosphere(5);
  CounterRandom random(5);
  for (Triangle& t : exchanged.triangles) {
    for (std::uint32_t& v : t) {
      v = static_cast<std::uint32_t>(random.uniform() * static_cast<double>(exchanged.vertices.size()));
    }
  }
  EXPECT_THROW(SurfaceTree{exchanged}, InputError);
  TriangleMesh moved = icosphere(4);  // one that is only odd
  moved.vertices[7] = 9.0 * moved.vertices[7];
  EXPECT_NO_THROW(SurfaceTree{moved});
}

TEST(SurfaceTree, FarAwayPoints) {
  const TriangleMesh mesh = icosphere(2);
  const SurfaceTree tree(mesh);
  for (const double far : {1e3, 1e4, 9e4, 2e5, 1e9, 1e100}) {
    const Vec3d p = far * normalized(Vec3d{1, 2, 3});
    ASSERT_EQ(tree.closest(p).triangle, closest_by_force(mesh, p).triangle) << far;
    ASSERT_LT(tree.signed_distance(p), 0);
  }
}

TEST(SurfaceTree, SignOfACubeAtItsFacesEdgesAndCorners) {
  const SurfaceTree tree(cube(2.0, {-1, -1, -1}));
  CounterRandom random(4);
  for (int i = 0; i < 5000; ++i) {
    const Vec3d p = random_point(random, cube_about_origin(2));
    const Vec3d q{std::fabs(p.x) - 1, std::fabs(p.y) - 1, std::fabs(p.z) - 1};
    const double inside = std::max({q.x, q.y, q.z});
    const Vec3d out{std::max(q.x, 0.0), std::max(q.y, 0.0), std::max(q.z, 0.0)};
    ASSERT_NEAR(tree.signed_distance(p), inside < 0 ? -inside : -norm(out), 1e-12);
  }
  EXPECT_EQ(tree.signed_distance({1, 1, 1}), 0);
}

// On sharp blades the normal of one face alone gives wrong signs near the edges.
TEST(SurfaceTree, SignAtSharpEdges) {
  // A wedge around the z axis between angles 0 and 0.05, cut off at radius 1.
  const double x = std::cos(0.05), y = std::sin(0.05);
  const TriangleMesh mesh{
      {{0, 0, 0}, {1, 0, 0}, {x, y, 0}, {0, 0, 1}, {1, 0, 1}, {x, y, 1}},
      {{0, 2, 1}, {3, 4, 5}, {0, 1, 4}, {0, 4, 3}, {1, 2, 5}, {1, 5, 4}, {2, 0, 3}, {2, 3, 5}},
      {}};
  const SurfaceTree tree(mesh);
  CounterRandom random(9);
  for (int i = 0; i < 20000; ++i) {
    const double radius = random.uniform(0, 0.9), angle = random.uniform(-std::numbers::pi, std::numbers::pi),
                 z = random.uniform(0.1, 0.9);
    const bool inside = angle > 0 && angle < 0.05;
    const double d = tree.signed_distance({radius * std::cos(angle), radius * std::sin(angle), z});
    ASSERT_EQ(d > 0, inside) << radius << " " << angle;
  }
}

// The lobes of a contact binary reach into one another; a pebble lies wholly inside the second.
TEST(SurfaceTree, OverlappingComponentsCountAsTheirUnion) {
  const TriangleMesh mesh = joined(two_spheres(4, 1, 1.4), icosphere(3, 0.2, {1, 0.2, 0}));
  const SurfaceTree tree(mesh);
  CounterRandom random(12);
  for (int i = 0; i < 5000; ++i) {
    const Vec3d p = random_point(random, cube_about_origin(2));
    const double depth = 1 - std::min(norm(p - Vec3d{-0.7, 0, 0}), norm(p - Vec3d{0.7, 0, 0}));
    const double d = tree.signed_distance(p);
    ASSERT_NEAR(d, depth, 6e-3);
  }
}

// The wall of a cavity is wound the other way, and its inside is outside the body.
TEST(SurfaceTree, HollowBody) {
  const SurfaceTree tree(joined(icosphere(4), reversed(icosphere(4, 0.5))));
  EXPECT_NEAR(tree.signed_distance({0, 0, 0}), -0.5, 5e-3);
  EXPECT_NEAR(tree.signed_distance({0, 0.6, 0}), 0.1, 5e-3);
  EXPECT_NEAR(tree.signed_distance({0, 0, 1.5}), -0.5, 5e-3);
}

TEST(SurfaceTree, ManyThreadsAskAtOnce) {
  const TriangleMesh mesh = torus(1, 0.3);
  const SurfaceTree tree(mesh);
  std::vector<double> one(2000), many(2000);
  const auto ask = [&](std::vector<double>& out) {
    parallel_for(0, 2000, [&](std::int64_t i) {
      CounterRandom random(8, static_cast<std::uint64_t>(i));
      out[static_cast<std::size_t>(i)] = tree.signed_distance(random_point(random, cube_about_origin(1.5)));
    });
  };
  {
    const ThreadLimit limit(1);
    ask(one);
  }
  const ThreadLimit limit(4);
  ask(many);
  EXPECT_EQ(one, many);
}

TEST(SurfaceTree, DegenerateTrianglesAreSegments) {
  const SurfaceTree tree({{{0, 0, 0}, {1, 0, 0}, {0.5, 0, 0}}, {{0, 1, 2}}, {}});
  EXPECT_DOUBLE_EQ(tree.closest({0.25, 2, 0}).distance, 2);
  EXPECT_EQ(tree.closest({0.25, 2, 0}).normal, Vec3d{});
  EXPECT_DOUBLE_EQ(SurfaceTree({{{1, 1, 1}}, {{0, 0, 0}}, {}}).closest({1, 1, 4}).distance, 3);
}

TEST(SurfaceTree, WrongMeshesAreTheUsersError) {
  EXPECT_THROW(SurfaceTree(TriangleMesh{}), InputError);
  EXPECT_THROW(SurfaceTree({{{0, 0, 0}}, {{0, 0, 1}}, {}}), InputError);
  TriangleMesh mesh = cube();
  mesh.vertices[3].y = std::numeric_limits<double>::quiet_NaN();
  EXPECT_THROW(SurfaceTree{mesh}, InputError);
}

const Vec3d kA{0, 0, 0}, kB{4, 0, 0}, kC{0, 3, 0};

TEST(ClosestOnTriangle, EachFeature) {
  using F = TriangleFeature;
  EXPECT_EQ(closest_on_triangle({1, 1, 5}, kA, kB, kC).feature, F::face);
  EXPECT_DOUBLE_EQ(closest_on_triangle({1, 1, 5}, kA, kB, kC).squared_distance, 25);
  EXPECT_EQ(closest_on_triangle({-1, -1, 2}, kA, kB, kC).feature, F::corner_a);
  EXPECT_EQ(closest_on_triangle({9, -1, 2}, kA, kB, kC).feature, F::corner_b);
  EXPECT_EQ(closest_on_triangle({-1, 9, 2}, kA, kB, kC).feature, F::corner_c);
  EXPECT_EQ(closest_on_triangle({1, -2, 0}, kA, kB, kC).feature, F::side_ab);
  EXPECT_EQ(closest_on_triangle({3, 4, 1}, kA, kB, kC).feature, F::side_bc);
  EXPECT_EQ(closest_on_triangle({-1, 1, 0}, kA, kB, kC).feature, F::side_ca);
}

// At an obtuse corner, a test by the two sides of the corner alone goes wrong.
TEST(ClosestOnTriangle, BeatsADenseSearch) {
  CounterRandom random(1);
  const auto vector = [&] { return Vec3d{random.normal(), random.normal(), random.normal()}; };
  for (int trial = 0; trial < 200; ++trial) {
    const Vec3d p = 3.0 * vector(), u = vector(), v = vector(), w = u + 0.1 * vector();
    const auto found = closest_on_triangle(p, u, v, w);
    double best = 1e300;
    for (int i = 0; i <= 60; ++i) {
      for (int j = 0; j <= 60 - i; ++j) {
        best = std::min(best, squared_norm(p - (u + (i / 60.0) * (v - u) + (j / 60.0) * (w - u))));
      }
    }
    const double longest = std::max(norm(v - u), norm(v - w));
    ASSERT_LE(found.squared_distance, best * (1 + 1e-12));
    ASSERT_GE(std::sqrt(found.squared_distance), std::sqrt(best) - longest / 60);
  }
}

TEST(ClosestOnTriangle, SegmentsAndPoints) {
  EXPECT_DOUBLE_EQ(closest_on_triangle({1, 2, 0}, kA, kB, {2, 0, 0}).squared_distance, 4);
  EXPECT_DOUBLE_EQ(closest_on_triangle({5, 0, 0}, kA, {2, 0, 0}, kB).squared_distance, 1);
  EXPECT_DOUBLE_EQ(closest_on_triangle({1, 2, 2}, kA, kA, kA).squared_distance, 9);
}

TEST(WindingNumber, CountsHowOftenASurfaceGoesAround) {
  const TriangleMesh pair = testing::two_spheres(2, 1.0, 1.0);  // at x = -0.5 and 0.5
  EXPECT_NEAR(winding_number(pair, {0, 0, 0}), 2.0, 1e-9);
  EXPECT_NEAR(winding_number(pair, {1.2, 0, 0}), 1.0, 1e-9);
  EXPECT_NEAR(winding_number(pair, {3, 0, 0}), 0.0, 1e-9);
  EXPECT_NEAR(winding_number(testing::reversed(pair), {1.2, 0, 0}), -1.0, 1e-9);
}

TEST(SurfaceDistance, ConcentricSpheres) {
  const auto r = surface_distance(icosphere(5, 1), icosphere(5, 1.1), 4000, 1);
  EXPECT_NEAR(r.mean, 0.1, 1e-3);
  EXPECT_NEAR(r.p99, 0.1, 1e-3);
  EXPECT_NEAR(r.max, 0.1, 1e-3);
}

// The small body a is part of b, so that every point of a lies on b. The other sphere of b is far from a.
TEST(SurfaceDistance, LooksInBothDirections) {
  const TriangleMesh a = icosphere(4), b = joined(a, icosphere(4, 1, {5, 0, 0}));
  const auto r = surface_distance(a, b, 4000, 1);
  EXPECT_LT(r.from_a_to_b.max, 1e-9);
  EXPECT_NEAR(r.from_b_to_a.max, 5, 0.1);
  EXPECT_NEAR(r.mean, (r.from_a_to_b.mean + r.from_b_to_a.mean) / 2, 1e-12);
  EXPECT_EQ(r.max, r.from_b_to_a.max);
}

// A strip of height 1 stands upright on a floor: its distances to the floor are uniform in [0, 1].
TEST(SurfaceDistance, FiguresOfAKnownDistribution) {
  const TriangleMesh strip{{{0, 0, 0}, {1, 0, 0}, {1, 0, 1}, {0, 0, 1}}, {{0, 1, 2}, {0, 2, 3}}, {}};
  const TriangleMesh floor{{{-1, -1, 0}, {2, -1, 0}, {2, 1, 0}, {-1, 1, 0}}, {{0, 1, 2}, {0, 2, 3}}, {}};
  const auto r = surface_distance(strip, floor, 40000, 7).from_a_to_b;
  EXPECT_NEAR(r.mean, 0.5, 5 * 0.29 / 200);
  EXPECT_NEAR(r.p99, 0.99, 5 * 0.1 / 200);
  EXPECT_NEAR(r.max, 1, 1e-3);
  EXPECT_LE(r.max, 1);
}

// One of a hundred distances is larger.
TEST(SurfaceDistance, ThePercentileIsANearestRank) {
  const auto r = surface_distance(icosphere(2), torus(1, 0.3), 100, 2).from_a_to_b;
  EXPECT_LT(r.p99, r.max);
}

TEST(SurfaceDistance, ScalesWithTheUnit) {
  const auto small = surface_distance(icosphere(3, 1e-3), torus(1e-3, 3e-4), 500, 2);
  const auto large = surface_distance(icosphere(3, 1e5), torus(1e5, 3e4), 500, 2);
  EXPECT_NEAR(large.mean / small.mean, 1e8, 1);
}

TEST(SurfaceDistance, NeedsASample) { EXPECT_THROW(surface_distance(cube(), cube(), 0, 1), InputError); }

}  // namespace
}  // namespace astrolith
