#include "geometry/surface/surface_tree.h"

#include <limits>
#include <numbers>

#include "geometry/surface/closest_on_triangle.h"
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

}  // namespace
}  // namespace astrolith
