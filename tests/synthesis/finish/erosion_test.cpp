#include "synthesis/finish/erosion.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "geometry/mesh_measure.h"
#include "geometry/mesh_topology.h"
#include "gravity/vertical_directions.h"
#include "numerics/errors.h"
#include "synthesis/field/field_mesh.h"
#include "tests/synthesis/bodies.h"

namespace astrolith {
namespace {

constexpr double kDegrees = 180.0 / std::numbers::pi;

// Steep hills without overhangs all over a ball.
Recipe hilly_ball() {
  Recipe recipe = testing::sphere_recipe(0.5);
  recipe.layers = {testing::fractal_layer(0.04, 3.0, 2)};
  return recipe;
}

struct Eroded {
  TriangleMesh before, after;
  std::vector<Vec3d> up;
  ErosionStatistics statistics;
};

Eroded eroded(const Recipe& recipe, int resolution, double talus_angle, int most_sweeps = 100000,
              const BodyMotion& motion = {}) {
  const ImplicitField field(recipe);
  MeshCollector collector;
  mesh_field(field, field.bounds(), resolution, collector);
  Eroded result{collector.mesh, collector.mesh, {}, {}};
  result.up = vertical_directions(result.before, motion);
  result.statistics = erode(result.after, result.up, talus_angle, most_sweeps);
  return result;
}

// Rock, by its definition: a face of the vertex leans over, or stands within 5 degrees of the vertical.
std::vector<bool> find_rock(const Eroded& e) {
  std::vector<bool> rock(e.up.size(), false);
  for (const Triangle& t : e.before.triangles) {
    const Vec3d& p = e.before.vertices[t[0]];
    const Vec3d normal = normalized(cross(e.before.vertices[t[1]] - p, e.before.vertices[t[2]] - p));
    for (const std::uint32_t v : t) rock[v] = rock[v] || dot(normal, e.up[v]) < 0.0872;
  }
  return rock;
}

// The steepest slope of all edges between vertices that are not rock, in degrees.
double steepest_edge(const TriangleMesh& mesh, const std::vector<Vec3d>& up,
                     const std::vector<bool>& rock = {}) {
  double steepest = 0.0;
  for (const Triangle& t : mesh.triangles) {
    for (std::size_t k = 0; k < 3; ++k) {
      const std::uint32_t a = t[k], b = t[(k + 1) % 3];
      if (!rock.empty() && (rock[a] || rock[b])) continue;
      const Vec3d d = mesh.vertices[a] - mesh.vertices[b], vertical = normalized(up[a] + up[b]);
      const double drop = dot(d, vertical);
      steepest = std::max(steepest, std::atan2(std::abs(drop), norm(d - drop * vertical)));
    }
  }
  return steepest * kDegrees;
}

TEST(Erosion, EndsWithoutASlopeAboveTheTalusAngle) {
  const Eroded e = eroded(hilly_ball(), 64, 30.0);
  EXPECT_TRUE(e.statistics.settled);
  EXPECT_GT(e.statistics.moved_vertices, 1000);
  EXPECT_GT(e.statistics.steepest_before, 45.0);
  EXPECT_LE(e.statistics.steepest_after, 30.0);
  EXPECT_EQ(e.statistics.rock_vertices, 0);
  EXPECT_LE(steepest_edge(e.after, e.up), 30.0);
}

TEST(Erosion, ConservesMass) {
  const Eroded e = eroded(hilly_ball(), 64, 30.0);
  EXPECT_GT(e.statistics.volume_moved, 1e-3 * volume(e.before));
  EXPECT_NEAR(volume(e.after) / volume(e.before), 1.0, 1e-12);
}

// Faces that looked up still do: a surface that was a graph over the horizontal still is one.
TEST(Erosion, StaysClosedAndDoesNotRunIntoItself) {
  const Eroded e = eroded(hilly_ball(), 64, 25.0);
  const MeshTopology topology = analyze_topology(e.after);
  EXPECT_TRUE(topology.closed && topology.manifold && topology.oriented);
  const auto upward = [&](const TriangleMesh& mesh, const Triangle& t) {
    const Vec3d &a = mesh.vertices[t[0]], &b = mesh.vertices[t[1]], &c = mesh.vertices[t[2]];
    return dot(normalized(cross(b - a, c - a)), e.up[t[0]]);
  };
  for (const Triangle& t : e.after.triangles) {
    if (upward(e.before, t) > 0.1) {
      ASSERT_GT(upward(e.after, t), 0.0);
    }
  }
  for (const Vec3d& normal : e.after.normals) ASSERT_NEAR(norm(normal), 1.0, 1e-5);
}

// On a fast rotator verticals lean towards the poles, material runs to the equator, and much volume has to be
// restored in the end. That lift must not leave slopes above the talus angle that are called settled.
TEST(Erosion, SettledIsSaidOfTheFinishedMesh) {
  Recipe lobes = testing::sphere_recipe(0.8, {-0.6, 0, 0});
  lobes.body->spheres.push_back({{0.6, 0, 0}, 0.8});
  lobes.body->blend_exponent = 3.0;
  lobes.layers = {testing::fractal_layer(0.05, 2.0, 3)};
  for (const double period : {2.7, 3.0}) {
    const Eroded e = eroded(lobes, 40, 15.0, 20000, {2000.0, period});
    EXPECT_GT(e.statistics.rock_vertices, 0) << period;
    EXPECT_DOUBLE_EQ(e.statistics.steepest_after, steepest_edge(e.after, e.up, find_rock(e))) << period;
    EXPECT_EQ(e.statistics.settled, e.statistics.steepest_after <= 15.0) << period;
    EXPECT_TRUE(e.statistics.settled) << period << ": " << e.statistics.steepest_after;
    EXPECT_NEAR(volume(e.after) / volume(e.before), 1.0, 1e-12) << period;
  }
}

// Ground slides far on clusters of vertices, so that sweeps hardly grow with the mesh. On vertices alone
// these slopes take ten times as many sweeps at twice the resolution or more.
TEST(Erosion, SweepsHardlyGrowWithTheMesh) {
  const Eroded coarse = eroded(hilly_ball(), 48, 20.0), fine = eroded(hilly_ball(), 144, 20.0);
  EXPECT_TRUE(coarse.statistics.settled && fine.statistics.settled);
  EXPECT_LT(fine.statistics.sweeps, 3 * coarse.statistics.sweeps);
}

// What moves is a matter of the body, not of its mesh.
TEST(Erosion, MovesAsMuchOnEveryMesh) {
  const Eroded coarse = eroded(hilly_ball(), 64, 25.0), fine = eroded(hilly_ball(), 128, 25.0);
  EXPECT_NEAR(coarse.statistics.volume_moved / fine.statistics.volume_moved, 1.0, 0.15);
  const auto share = [](const Eroded& e) {
    return double(e.statistics.moved_vertices) / double(e.after.vertices.size());
  };
  EXPECT_NEAR(share(coarse), share(fine), 0.1);
}

TEST(Erosion, GentleSlopesAndRockStay) {
  const Eroded gentle = eroded(testing::sphere_recipe(1.0), 32, 30.0);
  EXPECT_EQ(gentle.statistics.moved_vertices, 0);
  EXPECT_TRUE(gentle.statistics.settled);
  TriangleMesh mesh = gentle.before;
  const std::vector<Vec3d> nowhere(mesh.vertices.size());
  const ErosionStatistics rock = erode(mesh, nowhere, 30.0, 10);
  EXPECT_EQ(rock.rock_vertices, static_cast<std::int64_t>(mesh.vertices.size()));
  EXPECT_EQ(rock.moved_vertices, 0);
}

TEST(Erosion, StopsAtItsSweepsAndRefusesNonsense) {
  const Eroded e = eroded(hilly_ball(), 48, 20.0, 3);
  EXPECT_FALSE(e.statistics.settled);
  EXPECT_EQ(e.statistics.sweeps, 3);
  TriangleMesh mesh = e.before;
  EXPECT_THROW(erode(mesh, e.up, 0.0, 10), InputError);
  EXPECT_THROW(erode(mesh, e.up, 90.0, 10), InputError);
  EXPECT_THROW(erode(mesh, e.up, 20.0, 10, [](double, std::string_view) { return false; }), WorkError);
}

}  // namespace
}  // namespace astrolith
