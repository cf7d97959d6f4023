#include <cmath>
#include <cstring>
#include <map>
#include <numbers>

#include "geometry/mesh_measure.h"
#include "gravity/polyhedron_gravity.h"
#include "gravity/vertical_directions.h"
#include "numerics/errors.h"
#include "numerics/parallel_for.h"
#include "tests/support/meshes.h"

namespace astrolith {
namespace {

constexpr double kDegrees = 180.0 / std::numbers::pi;

double degrees_between(const Vec3d& a, const Vec3d& b) {
  return std::atan2(norm(cross(a, b)), dot(a, b)) * kDegrees;
}

TriangleMesh moved(TriangleMesh mesh, double scale, const Vec3d& by) {
  for (Vec3d& p : mesh.vertices) p = scale * p + by;
  return mesh;
}

// Two lobes, hills and hollows.
TriangleMesh rough_lobes() {
  TriangleMesh mesh = testing::icosphere(6);
  for (Vec3d& p : mesh.vertices) {
    const double hills =
        0.15 * std::sin(4 * p.x + 1) * std::cos(3 * p.y) + 0.02 * std::sin(15 * p.z + 9 * p.x);
    p = p * (1.0 + hills);
    const double neck = 0.6 + 0.4 * p.x * p.x;
    p = {2.0 * p.x, neck * p.y, neck * p.z};
  }
  return mesh;
}

struct Angles {
  double mean = 0.0, largest = 0.0;
};

// Compares one vertex in 16.
Angles angles_from_exact(const TriangleMesh& mesh, const std::vector<Vec3d>& up) {
  std::vector<Vec3d> points, ours;
  for (std::size_t i = 0; i < up.size(); i += 16) {
    points.push_back(mesh.vertices[i]);
    ours.push_back(up[i]);
  }
  const std::vector<Attraction> truth = PolyhedronGravity(mesh).at(points, 1e-4);
  Angles angles;
  for (std::size_t i = 0; i < ours.size(); ++i) {
    const double angle = degrees_between(ours[i], -1.0 * truth[i].acceleration);
    angles.mean += angle / static_cast<double>(ours.size());
    angles.largest = std::max(angles.largest, angle);
  }
  return angles;
}

TEST(VerticalDirections, AreTheNormalsOfABallAndTiltWithRotation) {
  const Vec3d center{10, -20, 30};
  const TriangleMesh ball = moved(testing::icosphere(5), 100.0, center);
  const std::vector<Vec3d> still = vertical_directions(ball, {}),
                           turning = vertical_directions(ball, {2500.0, 3.0});
  const double turn = 2 * std::numbers::pi / (3600 * 3.0);
  const double gravity = 4.0 / 3.0 * std::numbers::pi * 6.6743e-11 * 2500.0 * 100.0;
  for (std::size_t i = 0; i < ball.vertices.size(); ++i) {
    const Vec3d normal = normalized(ball.vertices[i] - center);
    EXPECT_LT(degrees_between(still[i], normal), 0.25);
    const Vec3d force = gravity * normal - turn * turn * 100.0 * Vec3d{normal.x, normal.y, 0.0};
    EXPECT_LT(degrees_between(turning[i], force), 0.45);
    EXPECT_NEAR(norm(turning[i]), 1.0, 1e-12);
  }
}

TEST(VerticalDirections, AreNearThoseOfTheExactPolyhedron) {
  const TriangleMesh mesh = rough_lobes();
  const Angles angles = angles_from_exact(mesh, vertical_directions(mesh, {}));
  EXPECT_LT(angles.mean, 0.3);
  EXPECT_LT(angles.largest, 2.0);
}

// The lattice is made finer until it holds a thin body: here a bar of 1 : 40.
TEST(VerticalDirections, OfAThinBar) {
  TriangleMesh bar = testing::icosphere(6);
  for (Vec3d& p : bar.vertices) p = {p.x, 0.025 * p.y, 0.025 * p.z};
  EXPECT_LT(angles_from_exact(bar, vertical_directions(bar, {})).mean, 3.0);
}

TEST(VerticalDirections, SameBitsForAnyThreads) {
  const TriangleMesh mesh = rough_lobes();
  const std::vector<Vec3d> many = vertical_directions(mesh, {2000.0, 4.0});
  const ThreadLimit limit(1);
  const std::vector<Vec3d> one = vertical_directions(mesh, {2000.0, 4.0});
  EXPECT_EQ(std::memcmp(one.data(), many.data(), one.size() * sizeof(Vec3d)), 0);
}

TEST(VerticalDirections, NeedASurface) { EXPECT_THROW(vertical_directions(TriangleMesh{}, {}), InputError); }

// Every directed edge is met as often as the opposite one: the facets enclose a volume.
bool is_closed(const TriangleMesh& mesh) {
  std::map<std::pair<std::uint32_t, std::uint32_t>, int> surplus;
  for (const Triangle& t : mesh.triangles) {
    for (std::size_t k = 0; k < 3; ++k) {
      ++surplus[{t[k], t[(k + 1) % 3]}];
      --surplus[{t[(k + 1) % 3], t[k]}];
    }
  }
  return std::all_of(surplus.begin(), surplus.end(), [](const auto& edge) { return edge.second == 0; });
}

TEST(CoarseSurface, IsClosedAndKeepsTheVolume) {
  const TriangleMesh ball = testing::icosphere(6);
  for (const auto& [cells, error] : {std::pair{12, 0.05}, std::pair{48, 0.004}}) {
    const CoarseSurface coarse = coarse_surface(ball, cells);
    EXPECT_TRUE(is_closed(coarse.mesh));
    EXPECT_NEAR(volume(coarse.mesh) / volume(ball), 1.0, error);
    EXPECT_LT(coarse.mesh.triangles.size(), 10.0 * cells * cells);
  }
}

TEST(CoarseSurface, EachVertexLiesNearTheMeanOfItsCell) {
  const TriangleMesh ball = testing::icosphere(5);
  const CoarseSurface coarse = coarse_surface(ball, 20);
  ASSERT_EQ(coarse.cell.size(), ball.vertices.size());
  for (std::size_t i = 0; i < ball.vertices.size(); ++i) {
    EXPECT_LE(norm(ball.vertices[i] - coarse.mesh.vertices[coarse.cell[i]]),
              std::sqrt(3.0) * 2.0 / 20 + 1e-9);
  }
}

TEST(CoarseSurface, OneCellHoldsAll) {
  const CoarseSurface coarse = coarse_surface(testing::icosphere(1), 1);
  EXPECT_TRUE(coarse.mesh.triangles.empty());
  EXPECT_LE(coarse.mesh.vertices.size(), 8u);  // those on the far sides of the box have cells of their own
}

}  // namespace
}  // namespace astrolith
