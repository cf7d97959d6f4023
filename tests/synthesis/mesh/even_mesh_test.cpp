#include "synthesis/mesh/even_mesh.h"

#include <algorithm>
#include <cmath>
#include <cstring>
#include <numbers>

#include "geometry/mesh_measure.h"
#include "geometry/mesh_topology.h"
#include "numerics/errors.h"
#include "synthesis/mesh/manifold_check.h"
#include "tests/synthesis/analytic_field.h"

namespace astrolith {
namespace {

using testing::AnalyticField;
using testing::cube_box;

AnalyticField even_test_field(double (*function)(const Vec3d&), double lipschitz) {
  return AnalyticField(function, lipschitz);
}

double plain_ball(const Vec3d& p) { return 1.0 - norm(p); }

double plain_ring(const Vec3d& p) { return 0.25 - std::hypot(std::hypot(p.x, p.y) - 0.7, p.z); }

// A die whose edges are sharp, and askew to the grid.
double die(const Vec3d& p) {
  const Vec3d u{0.36, 0.48, 0.8}, v{-0.8, 0.6, 0.0}, w{-0.48, -0.64, 0.6};
  return 0.5 - std::max({std::abs(dot(p, u)), std::abs(dot(p, v)), std::abs(dot(p, w))});
}

// A ball with caves and arches, whose rims are sharp.
double carved_ball(const Vec3d& p) {
  const double f = 12.0;
  const double gyroid = std::sin(f * p.x) * std::cos(f * p.y) + std::sin(f * p.y) * std::cos(f * p.z) +
                        std::sin(f * p.z) * std::cos(f * p.x);
  return std::min(0.95 - norm(p), 0.06 * (gyroid + 0.3));
}

struct EvenedMesh {
  RecordedMesh plain, even;
  EvenStatistics statistics;
  double step = 0.0;
};

template <int B = kBlockCells>
EvenedMesh evened(const AnalyticField& field, int resolution, MeshTile tile = {}) {
  EvenedMesh made;
  made.step = mesh_field<B>(field, cube_box(1.0), resolution, made.plain, {}, tile).step;
  made.even = made.plain;
  made.statistics = even_mesh(field, made.step, made.even, {});
  return made;
}

TriangleMesh collected(const RecordedMesh& recorded) {
  MeshCollector collector;
  recorded.replay(collector);
  return std::move(collector.mesh);
}

ManifoldReport checked(const RecordedMesh& mesh) {
  ManifoldCheck check;
  mesh.replay(check);
  return check.finish();
}

bool same_mesh(const RecordedMesh& a, const RecordedMesh& b) {
  return a.triangles == b.triangles && a.vertices.size() == b.vertices.size() &&
         std::memcmp(a.vertices.data(), b.vertices.data(), a.vertices.size() * sizeof(MeshVertex)) == 0;
}

std::int64_t turned_over(const RecordedMesh& mesh) {
  return std::count_if(mesh.triangles.begin(), mesh.triangles.end(), [&](const Triangle& t) {
    return is_turned_over(mesh.vertices[t[0]], mesh.vertices[t[1]], mesh.vertices[t[2]]);
  });
}

TEST(EvenMesh, ABallGetsEvenTrianglesOnItsSurface) {
  const EvenedMesh ball = evened(even_test_field(plain_ball, 1.0), 64);
  const EvenStatistics& done = ball.statistics;
  EXPECT_LT(done.before.first_percentile, 0.1);
  EXPECT_GT(done.after.first_percentile, 0.55);
  EXPECT_GT(done.after.mean, 0.9);
  EXPECT_GT(done.evaluations, 5 * done.moved);
  EXPECT_EQ(done.kept, 0);
  EXPECT_EQ(done.moved, static_cast<std::int64_t>(ball.plain.vertices.size()));
  EXPECT_LT(done.largest_value, 0x1p-10 * ball.step * 1.001);
  double largest = 0.0, sum = 0.0;
  for (std::size_t v = 0; v < ball.even.vertices.size(); ++v) {
    const auto& [position, normal] = ball.even.vertices[v];
    ASSERT_NEAR(norm(position), 1.0, 0x1p-10 * ball.step + 1e-6);
    ASSERT_NEAR(norm(normal), 1.0, 1e-6);
    ASSERT_GT(dot(normal, position), 0.9999);
    const double move = norm(position - ball.plain.vertices[v].position);
    largest = std::max(largest, move);
    sum += move;
  }
  EXPECT_NEAR(done.largest_move, largest, 1e-6);
  EXPECT_NEAR(done.mean_move, sum / double(ball.even.vertices.size()), 1e-6);
  EXPECT_LT(done.largest_move, ball.step);
  EXPECT_NEAR(volume(collected(ball.even)), 4.0 / 3.0 * std::numbers::pi, 0.005);
}

TEST(EvenMesh, TopologyStays) {
  const auto expect_same = [](const EvenedMesh& mesh, std::int64_t genus) {
    EXPECT_EQ(mesh.even.triangles, mesh.plain.triangles);
    const ManifoldReport report = checked(mesh.even);
    EXPECT_TRUE(report.closed() && report.manifold());
    EXPECT_EQ(report.genus, genus);
    EXPECT_EQ(analyze_topology(collected(mesh.even)).genus, genus);
    EXPECT_LE(turned_over(mesh.even), turned_over(mesh.plain));
    const double before = volume(collected(mesh.plain)), after = volume(collected(mesh.even));
    EXPECT_NEAR(after / before, 1.0, 0.01);
  };
  expect_same(evened(even_test_field(plain_ring, 1.0), 48), 1);
  const EvenedMesh carved = evened(even_test_field(carved_ball, 1.5), 48);
  expect_same(carved, checked(carved.plain).genus);
  EXPECT_GT(carved.statistics.after.first_percentile, 0.4);
}

// Marching cubes cuts edges off by a part of a cell. Evening must not round them further.
TEST(EvenMesh, SharpEdgesStaySharp) {
  const EvenedMesh mesh = evened(even_test_field(die, 1.0), 64);
  EXPECT_GT(mesh.statistics.after.first_percentile, 0.4);
  const double exact = 1.0, before = volume(collected(mesh.plain)), after = volume(collected(mesh.even));
  EXPECT_LT(std::abs(after - exact), std::abs(before - exact));
  EXPECT_EQ(turned_over(mesh.even), 0);
  for (const MeshVertex& v : mesh.even.vertices)
    ASSERT_LT(std::abs(die({v.position.x, v.position.y, v.position.z})), 0.5 * mesh.step);
}

TEST(EvenMesh, SameBytesForAnyThreadsAndBlocks) {
  const AnalyticField field = even_test_field(carved_ball, 1.5);
  const EvenedMesh usual = evened(field, 40);
  for (const int threads : {1, 2, 5}) {
    const ThreadLimit limit(threads);
    EXPECT_TRUE(same_mesh(evened(field, 40).even, usual.even)) << threads;
  }
  EXPECT_TRUE(same_mesh(evened<4>(field, 40).even, usual.even));
}

TEST(EvenMesh, CutsStayWhereTheyAreSoThatTilesFit) {
  const AnalyticField field = even_test_field(plain_ball, 1.0);
  for (int index = 0; index < 3; ++index) {
    const EvenedMesh tile = evened(field, 48, {index, 3});
    const TriangleMesh plain = collected(tile.plain);
    std::vector<int> balance(plain.vertices.size());
    for (const Triangle& t : plain.triangles) {
      for (std::size_t k = 0; k < 3; ++k)
        balance[t[k]] += static_cast<int>(t[(k + 1) % 3]) - static_cast<int>(t[(k + 2) % 3]);
    }
    std::int64_t open = 0;
    for (std::size_t v = 0; v < balance.size(); ++v) {
      if (balance[v] == 0) continue;
      ++open;
      ASSERT_EQ(std::memcmp(&tile.even.vertices[v], &tile.plain.vertices[v], sizeof(MeshVertex)), 0);
    }
    EXPECT_EQ(checked(tile.even).open_vertices, open);
    EXPECT_EQ(tile.statistics.kept, open);
    EXPECT_GT(tile.statistics.moved, open);
    EXPECT_GT(tile.statistics.after.first_percentile, tile.statistics.before.first_percentile);
  }
}

// Six triangles around a vertex, and the vertex moved out of them.
TEST(EvenMesh, TrianglesThatWouldTurnOverArePutBack) {
  const Vec3f up{0, 0, 1};
  std::vector<MeshVertex> plain{{{0, 0, 0}, up}};
  for (int k = 0; k < 6; ++k) {
    const double angle = k * std::numbers::pi / 3;
    plain.push_back({{static_cast<float>(std::cos(angle)), static_cast<float>(std::sin(angle)), 0}, up});
  }
  std::vector<Triangle> triangles;
  for (std::uint32_t k = 0; k < 6; ++k) triangles.push_back({0, k + 1, (k + 1) % 6 + 1});
  std::vector<MeshVertex> moved = plain;
  moved[0].position = {0.2f, 0.1f, 0};
  std::vector<MeshVertex> even = moved;
  put_back_turned(plain, triangles, even);
  EXPECT_EQ(even[0].position, moved[0].position);  // nothing turns over
  moved[0].position = {3, 0, 0};
  moved[4].position = {-2, 0, 0};  // no triangle at this vertex turns over by itself
  even = moved;
  put_back_turned(plain, triangles, even);
  EXPECT_EQ(even[0].position, plain[0].position);
  for (const Triangle& t : triangles) EXPECT_FALSE(is_turned_over(even[t[0]], even[t[1]], even[t[2]]));
}

TEST(EvenMesh, AMeshWithoutTrianglesStaysEmpty) {
  RecordedMesh nothing;
  const EvenStatistics done = even_mesh(even_test_field(plain_ball, 1.0), 0.1, nothing, {});
  EXPECT_EQ(done.moved, 0);
  EXPECT_EQ(done.after.mean, 0.0);
}

// The field is steep beyond measure on one half, so that no step along its gradient leads back there.
TEST(EvenMesh, VerticesThatDoNotComeBackStay) {
  const AnalyticField cliff([](const Vec3d& p) {
    const double f = 0.75 - norm(p);
    return p.z > 0.0 ? (f > 0.0 ? 1.0 : -1.0) : f;
  });
  const EvenedMesh mesh = evened(cliff, 32);
  EXPECT_GT(mesh.statistics.kept, 0);
  EXPECT_GT(mesh.statistics.moved, 0);
  EXPECT_LT(mesh.statistics.largest_value, 0x1p-5 * mesh.step * 1.001);
  EXPECT_TRUE(checked(mesh.even).closed());
  EXPECT_LE(turned_over(mesh.even), turned_over(mesh.plain));
}

TEST(EvenMesh, ProgressCanStopIt) {
  RecordedMesh mesh;
  const AnalyticField field = even_test_field(plain_ball, 1.0);
  const double step = mesh_field(field, cube_box(1.0), 32, mesh).step;
  EXPECT_THROW(even_mesh(field, step, mesh, [](double, std::string_view) { return false; }), WorkError);
}

}  // namespace
}  // namespace astrolith
