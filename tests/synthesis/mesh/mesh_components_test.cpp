#include <algorithm>
#include <cmath>

#include "geometry/mesh_measure.h"
#include "geometry/mesh_topology.h"
#include "numerics/errors.h"
#include "synthesis/mesh/manifold_check.h"
#include "synthesis/mesh/mesh_components.h"
#include "synthesis/mesh/mesher.h"
#include "tests/synthesis/analytic_field.h"

namespace astrolith {
namespace {

using testing::AnalyticField;
using testing::cube_box;

// A hollow ball, a torus and two crumbs: with the wall of the cavity, five components.
double five_components(const Vec3d& p) {
  const double ball = 0.45 - norm(p - Vec3d{-0.4, 0, 0}), hollow = 0.15 - norm(p - Vec3d{-0.45, 0, 0});
  const Vec3d q = p - Vec3d{0.55, 0, 0};
  const double torus = 0.1 - std::hypot(std::hypot(q.x, q.y) - 0.25, q.z);
  const double crumb = 0.06 - norm(p - Vec3d{0.55, 0.02, 0.5}),
               crumb2 = 0.05 - norm(p - Vec3d{0.0, 0.6, -0.6});
  return std::max({std::min(ball, -hollow), torus, crumb, crumb2});
}

const AnalyticField kFiveComponents(five_components, 1.0);

TriangleMesh kept(double least_share, std::int64_t* dropped = nullptr, int resolution = 60) {
  ComponentSizes sizes;
  mesh_field(kFiveComponents, cube_box(1.0), resolution, sizes);
  const ComponentChoice choice = sizes.larger_than(least_share);
  if (dropped != nullptr) *dropped = choice.dropped_components;
  MeshCollector collector;
  ComponentFilter filter(choice, collector);
  mesh_field(kFiveComponents, cube_box(1.0), resolution, filter);
  filter.finish();
  return std::move(collector.mesh);
}

TEST(MeshComponents, SmallComponentsAreDroppedAndTheOthersStayTheSame) {
  // Volumes relative to the ball, .382: cavity .037, torus .13, crumbs .0024 and .0014.
  struct Expected {
    double least_share;
    std::int64_t components, dropped;
  };
  for (const Expected e : {Expected{0.0, 5, 0}, {0.0015, 4, 1}, {0.01, 3, 2}, {0.08, 2, 3}, {1.0, 1, 4}}) {
    std::int64_t dropped = -1;
    const TriangleMesh mesh = kept(e.least_share, &dropped);
    const MeshTopology topology = analyze_topology(mesh);
    EXPECT_EQ(topology.components, e.components) << e.least_share;
    EXPECT_EQ(dropped, e.dropped) << e.least_share;
    EXPECT_TRUE(topology.closed && topology.manifold && topology.oriented);
    EXPECT_EQ(topology.unused_vertices, 0);
  }
  MeshCollector whole;
  mesh_field(kFiveComponents, cube_box(1.0), 60, whole);
  const TriangleMesh all = kept(0.0);
  EXPECT_EQ(all.vertices, whole.mesh.vertices);
  EXPECT_EQ(all.triangles, whole.mesh.triangles);
}

TEST(MeshComponents, TheKeptMeshIsAStreamAgain) {
  ComponentSizes sizes;
  mesh_field(kFiveComponents, cube_box(1.0), 120, sizes);
  ManifoldCheck check;
  ComponentFilter filter(sizes.larger_than(0.01), check);
  mesh_field(kFiveComponents, cube_box(1.0), 120, filter);
  filter.finish();
  const ManifoldReport report = check.finish();
  EXPECT_TRUE(report.closed() && report.manifold());
  EXPECT_EQ(report.components, 3);
  EXPECT_EQ(report.genus, 1);
}

// Horseshoes: arms that join only in the last layers have a label each until then.
TEST(MeshComponents, ArmsThatJoinLateAreOnePiece) {
  const AnalyticField comb(
      [](const Vec3d& p) {
        const double back = 0.1 - std::max(std::abs(p.z - 0.7), std::hypot(p.x, p.y) - 0.7);
        double arms = -1.0;
        for (const double x : {-0.5, 0.0, 0.5}) {
          arms = std::max(arms, std::min(0.1 - std::hypot(p.x - x, p.y), 0.75 - std::abs(p.z)));
        }
        return std::max(back, arms);
      },
      1.5);
  ComponentSizes sizes;
  mesh_field(comb, cube_box(1.0), 64, sizes);
  const ComponentChoice choice = sizes.larger_than(1.0);
  EXPECT_EQ(choice.dropped_components, 0);
  EXPECT_GE(choice.keep.size(), 3u);
}

ManifoldReport check_at_once(std::size_t vertices, const std::vector<Triangle>& triangles) {
  ManifoldCheck check;
  check.add_vertices(std::vector<MeshVertex>(vertices));
  check.add_triangles(triangles);
  return check.finish();
}

std::vector<Triangle> tetrahedron(std::uint32_t a, std::uint32_t b, std::uint32_t c, std::uint32_t d) {
  return {{a, b, c}, {a, c, d}, {a, d, b}, {b, d, c}};
}

TEST(ManifoldCheck, AgreesWithTheTopologyOfTheWholeMeshWhileItStreams) {
  // Tubes along the edges of a lattice, inside a sphere: many handles and some loose components.
  const auto tubes = [](const Vec3d& p) {
    const auto wave = [](double v) { return std::cos(9.0 * v); };
    return std::min(0.9 - norm(p), 0.1 * (wave(p.x) + wave(p.y) + wave(p.z) - 0.7));
  };
  const AnalyticField field(tubes, 1.6);
  MeshCollector collector;
  ManifoldCheck check;
  mesh_field(field, cube_box(1.0), 60, collector);
  mesh_field(field, cube_box(1.0), 60, check);
  const ManifoldReport report = check.finish();
  const MeshTopology topology = analyze_topology(collector.mesh);
  EXPECT_TRUE(report.closed() && report.manifold());
  EXPECT_TRUE(topology.closed && topology.manifold && topology.oriented);
  EXPECT_EQ(report.components, topology.components);
  EXPECT_EQ(report.genus, topology.genus);
  EXPECT_GT(report.genus, 3);
  EXPECT_EQ(report.vertices, static_cast<std::int64_t>(collector.mesh.vertices.size()));
}

TEST(ManifoldCheck, SeesBoundaries) {
  std::vector<Triangle> triangles = tetrahedron(0, 1, 2, 3);
  EXPECT_TRUE(check_at_once(4, triangles).closed());
  EXPECT_EQ(check_at_once(4, triangles).genus, 0);
  triangles.pop_back();
  const ManifoldReport open = check_at_once(4, triangles);
  EXPECT_FALSE(open.closed());
  EXPECT_TRUE(open.manifold());
  EXPECT_EQ(open.open_vertices, 3);
  EXPECT_EQ(open.genus, -1);
}

TEST(ManifoldCheck, SeesFlippedTriangles) {
  std::vector<Triangle> triangles = tetrahedron(0, 1, 2, 3);
  std::swap(triangles[0][0], triangles[0][1]);
  const ManifoldReport report = check_at_once(4, triangles);
  EXPECT_FALSE(report.closed() && report.manifold());
}

TEST(ManifoldCheck, SeesEdgesOfFourTrianglesAndVerticesOfTwoFans) {
  std::vector<Triangle> edge = tetrahedron(0, 1, 2, 3);
  for (const Triangle& t : tetrahedron(0, 1, 4, 5)) edge.push_back(t);
  EXPECT_EQ(check_at_once(6, edge).non_manifold_vertices, 2);
  std::vector<Triangle> vertex = tetrahedron(0, 1, 2, 3);
  for (const Triangle& t : tetrahedron(0, 4, 5, 6)) vertex.push_back(t);
  EXPECT_EQ(check_at_once(7, vertex).non_manifold_vertices, 1);
  EXPECT_EQ(check_at_once(7, vertex).components, 1);
  EXPECT_EQ(check_at_once(5, tetrahedron(0, 1, 2, 3)).non_manifold_vertices, 1) << "an unused vertex";
}

// Two triangles, and a tetrahedron and a triangle, that touch in vertex 0 only.
TEST(ManifoldCheck, SeesBorderVerticesOfTwoFans) {
  const ManifoldReport triangles = check_at_once(5, {{0, 1, 2}, {0, 3, 4}});
  EXPECT_EQ(triangles.non_manifold_vertices, 1);
  EXPECT_EQ(triangles.open_vertices, 4);
  for (const Triangle& t : {Triangle{0, 4, 5}, Triangle{4, 5, 0}}) {
    std::vector<Triangle> mixed = tetrahedron(0, 1, 2, 3);
    mixed.insert(mixed.begin(), t);
    EXPECT_EQ(check_at_once(6, mixed).non_manifold_vertices, 1);
  }
}

TEST(ManifoldCheck, RepeatedTrianglesAreNotManifold) {
  std::vector<Triangle> triangles = tetrahedron(0, 1, 2, 3);
  triangles.push_back(triangles[2]);
  EXPECT_FALSE(check_at_once(4, triangles).manifold());
}

TEST(ManifoldCheck, TrianglesOutsideTheWindowAreNotVouchedFor) {
  ManifoldCheck check;
  check.add_vertices(std::vector<MeshVertex>(4));
  check.add_triangles(tetrahedron(0, 1, 2, 3));
  check.add_vertices(std::vector<MeshVertex>(4));
  check.add_triangles(tetrahedron(4, 5, 6, 7));
  check.add_vertices(std::vector<MeshVertex>(4));
  check.add_triangles(tetrahedron(0, 9, 10, 11));
  const ManifoldReport report = check.finish();
  EXPECT_GT(report.late_triangles, 0);
  EXPECT_FALSE(report.closed());
}

TEST(ManifoldCheck, NothingIsNotClosed) {
  EXPECT_FALSE(check_at_once(0, {}).closed());
  ManifoldCheck check;
  EXPECT_THROW(check.add_triangles(std::vector<Triangle>{{0, 1, 2}}), WorkError);
}

}  // namespace
}  // namespace astrolith
