#include "synthesis/mesh/mesh_components.h"

#include <cmath>

#include "geometry/mesh_measure.h"
#include "geometry/mesh_topology.h"
#include "synthesis/mesh/manifold_check.h"
#include "synthesis/mesh/mesher.h"
#include "tests/synthesis/analytic_field.h"

namespace astrolith {
namespace {

using testing::AnalyticField;
using testing::cube;

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
  mesh_field(kFiveComponents, cube(1.0), resolution, sizes);
  const ComponentChoice choice = sizes.larger_than(least_share);
  if (dropped != nullptr) *dropped = choice.dropped_components;
  MeshCollector collector;
  ComponentFilter filter(choice, collector);
  mesh_field(kFiveComponents, cube(1.0), resolution, filter);
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
  mesh_field(kFiveComponents, cube(1.0), 60, whole);
  const TriangleMesh all = kept(0.0);
  EXPECT_EQ(all.vertices, whole.mesh.vertices);
  EXPECT_EQ(all.triangles, whole.mesh.triangles);
}

TEST(MeshComponents, TheKeptMeshIsAStreamAgain) {
  ComponentSizes sizes;
  mesh_field(kFiveComponents, cube(1.0), 120, sizes);
  ManifoldCheck check;
  ComponentFilter filter(sizes.larger_than(0.01), check);
  mesh_field(kFiveComponents, cube(1.0), 120, filter);
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
  mesh_field(comb, cube(1.0), 64, sizes);
  const ComponentChoice choice = sizes.larger_than(1.0);
  EXPECT_EQ(choice.dropped_components, 0);
  EXPECT_GE(choice.keep.size(), 3u);
}

}  // namespace
}  // namespace astrolith
