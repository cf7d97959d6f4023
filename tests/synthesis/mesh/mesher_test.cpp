#include "synthesis/mesh/mesher.h"

#include <algorithm>
#include <cstring>
#include <numbers>
#include <tuple>

#include "geometry/mesh_measure.h"
#include "geometry/mesh_topology.h"
#include "geometry/wound_surface.h"
#include "numerics/hash_random.h"
#include "synthesis/mesh/manifold_check.h"
#include "tests/synthesis/analytic_field.h"

namespace astrolith {
namespace {

using testing::AnalyticField;
using testing::cube_box;

TriangleMesh checked_mesh(const MeshStatistics& statistics, MeshCollector& collector) {
  EXPECT_EQ(statistics.vertices, static_cast<std::int64_t>(collector.mesh.vertices.size()));
  EXPECT_EQ(statistics.triangles, static_cast<std::int64_t>(collector.mesh.triangles.size()));
  return std::move(collector.mesh);
}

TriangleMesh make_mesh(const AnalyticField& field, const Box& bounds, int resolution) {
  MeshCollector collector;
  const MeshStatistics statistics = mesh_field(field, bounds, resolution, collector);
  return checked_mesh(statistics, collector);
}

// The mesh by blocks of B cells a side.
template <int B>
TriangleMesh mesh_by_blocks(const AnalyticField& field, const Box& bounds, int resolution) {
  MeshCollector collector;
  const MeshStatistics statistics = mesh_field<B>(field, bounds, resolution, collector);
  return checked_mesh(statistics, collector);
}

MeshTopology expect_closed_manifold(const TriangleMesh& mesh) {
  const MeshTopology topology = analyze_topology(mesh);
  EXPECT_TRUE(topology.closed);
  EXPECT_TRUE(topology.manifold);
  EXPECT_TRUE(topology.oriented);
  EXPECT_EQ(topology.degenerate_triangles, 0);
  EXPECT_EQ(topology.unused_vertices, 0);
  return topology;
}

std::int64_t coincident_vertices(const TriangleMesh& mesh) {
  std::vector<std::tuple<double, double, double>> points;
  for (const Vec3d& p : mesh.vertices) points.emplace_back(p.x, p.y, p.z);
  std::sort(points.begin(), points.end());
  const auto unique_end = std::unique(points.begin(), points.end());
  return points.end() - unique_end;
}

bool same_bytes(const TriangleMesh& a, const TriangleMesh& b) {
  const auto same = [](const auto& u, const auto& v) {
    return u.size() == v.size() && std::memcmp(u.data(), v.data(), u.size() * sizeof(u[0])) == 0;
  };
  return same(a.vertices, b.vertices) && same(a.normals, b.normals) && same(a.triangles, b.triangles);
}

AnalyticField make_field(double (*function)(const Vec3d&), double lipschitz) {
  return AnalyticField(function, lipschitz);
}

double unit_sphere(const Vec3d& p) { return 1.0 - norm(p); }

double torus(const Vec3d& p) {
  const double ring = std::hypot(p.x, p.y) - 0.7;
  return 0.25 - std::hypot(ring, p.z);
}

double two_spheres(const Vec3d& p) {
  return std::max(0.4 - norm(p - Vec3d{-0.55, 0.05, 0.1}), 0.35 - norm(p - Vec3d{0.5, 0, 0}));
}

double shell(const Vec3d& p) { return 0.2 - std::abs(norm(p) - 0.75); }

// A sphere with a gyroid carved into it: caves, arches, many handles.
double gyroid_sphere(const Vec3d& p) {
  const double f = 12.0;
  const double gyroid = std::sin(f * p.x) * std::cos(f * p.y) + std::sin(f * p.y) * std::cos(f * p.z) +
                        std::sin(f * p.z) * std::cos(f * p.x);
  return std::min(0.95 - norm(p), 0.06 * (gyroid + 0.3));
}
constexpr double kGyroidLipschitz = 1.5;  // 0.06 * 12 * sqrt(3) < 1.25

TEST(Mesher, SphereHasItsTopologyVolumeAndNormals) {
  const TriangleMesh mesh = make_mesh(make_field(unit_sphere, 1.0), cube_box(1.0), 64);
  const MeshTopology topology = expect_closed_manifold(mesh);
  EXPECT_EQ(topology.components, 1);
  EXPECT_EQ(topology.genus, 0);
  EXPECT_EQ(topology.euler_characteristic, 2);
  EXPECT_NEAR(volume(mesh), 4.0 / 3.0 * std::numbers::pi, 0.005);
  for (std::size_t i = 0; i < mesh.vertices.size(); ++i) {
    ASSERT_NEAR(norm(mesh.vertices[i]), 1.0, 5e-4);
    ASSERT_GT(dot(mesh.normals[i], normalized(mesh.vertices[i])), 0.9999);
    ASSERT_NEAR(norm(mesh.normals[i]), 1.0, 1e-6);
  }
}

TEST(Mesher, VolumeAndAreaConvergeWithTheSquareOfTheStep) {
  double volume_error = 0.0, area_error = 0.0;
  for (const int resolution : {18, 34, 66}) {
    const TriangleMesh mesh = make_mesh(make_field(unit_sphere, 1.0), cube_box(1.0), resolution);
    const double v = std::abs(volume(mesh) - 4.0 / 3.0 * std::numbers::pi);
    const double a = std::abs(surface_area(mesh) - 4.0 * std::numbers::pi);
    if (resolution != 18) {
      EXPECT_NEAR(volume_error / v, 4.0, 0.6);
      EXPECT_NEAR(area_error / a, 4.0, 0.6);
    }
    volume_error = v;
    area_error = a;
  }
}

TEST(Mesher, GenusAndComponentsOfKnownBodies) {
  EXPECT_EQ(expect_closed_manifold(make_mesh(make_field(torus, 1.0), cube_box(1.0), 40)).genus, 1);
  const MeshTopology pair =
      expect_closed_manifold(make_mesh(make_field(two_spheres, 1.0), cube_box(1.0), 40));
  EXPECT_EQ(pair.components, 2);
  EXPECT_EQ(pair.euler_characteristic, 4);
  const TriangleMesh hollow = make_mesh(make_field(shell, 1.0), cube_box(1.0), 64);
  EXPECT_EQ(expect_closed_manifold(hollow).components, 2);
  const double expected = 4.0 / 3.0 * std::numbers::pi * (std::pow(0.95, 3) - std::pow(0.55, 3));
  EXPECT_NEAR(volume(hollow), expected, 0.01);
}

TEST(Mesher, StatisticsAgreeWithTheMesh) {
  MeshCollector collector;
  const MeshStatistics statistics = mesh_field(make_field(torus, 1.0), cube_box(1.0), 48, collector);
  EXPECT_EQ(statistics.euler_characteristic(), analyze_topology(collector.mesh).euler_characteristic);
  EXPECT_GT(statistics.active_blocks, 0);
  EXPECT_LT(statistics.active_blocks, statistics.total_blocks);
  EXPECT_LT(statistics.evaluations, 49 * 49 * 49);
  EXPECT_DOUBLE_EQ(statistics.step, 2.0 / 46);
}

TEST(Mesher, SameBytesForAnyThreadsBlocksAndBounds) {
  const auto field = make_field(gyroid_sphere, kGyroidLipschitz);
  const TriangleMesh reference = make_mesh(field, cube_box(1.0), 77);
  EXPECT_GT(expect_closed_manifold(reference).genus, 10);
  for (const int threads : {1, 2, 4}) {
    const ThreadLimit limit(threads);
    EXPECT_TRUE(same_bytes(reference, make_mesh(field, cube_box(1.0), 77))) << threads << " threads";
  }
  EXPECT_TRUE(same_bytes(reference, mesh_by_blocks<4>(field, cube_box(1.0), 77)));
  EXPECT_TRUE(same_bytes(reference, mesh_by_blocks<5>(field, cube_box(1.0), 77)));
  EXPECT_TRUE(same_bytes(reference, mesh_by_blocks<16>(field, cube_box(1.0), 77)));
  const AnalyticField never_culled(gyroid_sphere);
  EXPECT_TRUE(same_bytes(reference, make_mesh(never_culled, cube_box(1.0), 77)));
}

// All tiles in one mesh. Vertices of a cut, which two tiles share, become one vertex.
TriangleMesh joined_tiles(const AnalyticField& field, int resolution, int count) {
  TriangleMesh all;
  for (int i = 0; i < count; ++i) {
    MeshCollector tile;
    ManifoldCheck check;
    const MeshStatistics statistics = mesh_field(field, cube_box(1.0), resolution, tile, {}, {i, count});
    mesh_field(field, cube_box(1.0), resolution, check, {}, {i, count});
    EXPECT_EQ(check.finish().open_vertices, statistics.cut_vertices);
    const auto first = static_cast<std::uint32_t>(all.vertices.size());
    all.vertices.insert(all.vertices.end(), tile.mesh.vertices.begin(), tile.mesh.vertices.end());
    all.normals.insert(all.normals.end(), tile.mesh.normals.begin(), tile.mesh.normals.end());
    for (const Triangle& t : tile.mesh.triangles) {
      all.triangles.push_back({t[0] + first, t[1] + first, t[2] + first});
    }
  }
  return weld_vertices(std::move(all), 0.0);
}

TEST(Mesher, TilesJoinToTheWholeMeshBitByBit) {
  const auto field = make_field(gyroid_sphere, kGyroidLipschitz);
  const TriangleMesh whole = make_mesh(field, cube_box(1.0), 77);
  for (const int count : {1, 2, 3, 10}) {
    EXPECT_TRUE(same_bytes(whole, joined_tiles(field, 77, count))) << count << " tiles";
  }
}

TEST(Mesher, TilesThatThereAreNotAreInputErrors) {
  MeshCollector sink;
  const auto field = make_field(unit_sphere, 1.0);
  for (const MeshTile tile : {MeshTile{0, 0}, {2, 2}, {-1, 2}, {0, 9}}) {
    EXPECT_THROW(mesh_field(field, cube_box(1.0), 64, sink, {}, tile), InputError);
  }
}

// The origin of the local coordinates: on a surface with caves, and on a sample of the grids below.
const Vec3d kPatchCenter{0.5, -0.25, 0.75};
constexpr double kPatchSize = 0.625;  // 20 cells of 1/32
constexpr int kPatchCells = 20;

// `mesh` makes the patch of a field into a sink.
template <class Mesh>
TriangleMesh gyroid_patch(const Mesh& mesh) {
  const AnalyticField local([](const Vec3d& p) { return gyroid_sphere(p + kPatchCenter); }, kGyroidLipschitz);
  MeshCollector collector;
  ManifoldCheck check;
  const MeshStatistics statistics = mesh(local, collector);
  mesh(local, check);
  const ManifoldReport report = check.finish();
  EXPECT_GT(statistics.cut_vertices, 0);
  EXPECT_EQ(report.open_vertices, statistics.cut_vertices);
  EXPECT_EQ(report.non_manifold_vertices, 0);
  return std::move(collector.mesh);
}

TriangleMesh gyroid_patch() {
  return gyroid_patch([](const AnalyticField& field, MeshSink& sink) {
    return mesh_patch(field, kPatchSize, kPatchCells, sink);
  });
}

template <int B>
TriangleMesh gyroid_patch_by_blocks() {
  return gyroid_patch([](const AnalyticField& field, MeshSink& sink) {
    return mesh_patch<B>(field, kPatchSize, kPatchCells, sink);
  });
}

TEST(Mesher, PatchesAreOpenOnlyWhereCutWhateverTheBlocks) {
  const TriangleMesh reference = gyroid_patch();
  EXPECT_TRUE(same_bytes(reference, gyroid_patch_by_blocks<4>()));
  EXPECT_TRUE(same_bytes(reference, gyroid_patch_by_blocks<16>()));
  const Box box = reference.bounds();
  EXPECT_GE(box.min.x, -0.5 * kPatchSize);
  EXPECT_LE(box.max.z, 0.5 * kPatchSize);
}

TEST(Mesher, PatchesHaveTheVerticesOfTheWholeMeshOnItsGrid) {
  const TriangleMesh whole = make_mesh(make_field(gyroid_sphere, kGyroidLipschitz), cube_box(1.0), 66);
  const TriangleMesh patch = gyroid_patch();
  std::vector<Vec3d> inside;
  for (const Vec3d& p : whole.vertices) {
    const Vec3d local = p - kPatchCenter;
    const double farthest = std::max({std::abs(local.x), std::abs(local.y), std::abs(local.z)});
    if (farthest <= 0.5 * kPatchSize) inside.push_back(local);
  }
  ASSERT_EQ(inside.size(), patch.vertices.size());
  // Vertices and triangles of both meshes come in rows of the grid.
  for (std::size_t i = 0; i < inside.size(); ++i) ASSERT_LT(norm(inside[i] - patch.vertices[i]), 1e-6);
}

TEST(Mesher, FlatBoxesUseFewerCellsAlongShortSides) {
  const Box flat{{-1.0, -0.95, -0.25}, {1.0, 0.95, 0.25}};
  const AnalyticField disk([](const Vec3d& p) { return 0.2 - norm(Vec3d{p.x / 4, p.y / 4, p.z}); }, 1.0);
  MeshCollector collector;
  const MeshStatistics statistics = mesh_field(disk, flat, 64, collector);
  EXPECT_EQ(statistics.total_blocks, 8 * 8 * 3);
  EXPECT_EQ(expect_closed_manifold(collector.mesh).genus, 0);
}

// Bounds whose grid has its samples at the integers: cells of side 1, and a border sample at -(half_side +
// 1).
constexpr int kTieHalfSide = 8;
constexpr int kTieResolution = 2 * kTieHalfSide + 2;

void expect_ties_handled(const AnalyticField::Function& function) {
  const auto inside_box = [&](const Vec3d& p) {
    const double reach = std::max({std::abs(p.x), std::abs(p.y), std::abs(p.z)});
    return reach > kTieHalfSide ? -1.0 : function(p);
  };
  const TriangleMesh mesh = make_mesh(AnalyticField(inside_box), cube_box(kTieHalfSide), kTieResolution);
  ASSERT_GT(mesh.triangles.size(), 0u);
  expect_closed_manifold(mesh);
  EXPECT_EQ(coincident_vertices(mesh), 0);
  for (const Vec3d& normal : mesh.normals) ASSERT_NEAR(norm(normal), 1.0, 1e-6);
}

TEST(Mesher, ValuesExactlyAtTheLevelGiveAManifoldWithoutCoincidentVertices) {
  expect_ties_handled([](const Vec3d& p) { return 5.0 - (std::abs(p.x) + std::abs(p.y) + std::abs(p.z)); });
  expect_ties_handled([](const Vec3d& p) { return 36.0 - squared_norm(p); });
  expect_ties_handled(
      [](const Vec3d& p) { return std::min(3.0 - std::abs(p.x), 4.0 - std::abs(p.y * p.z)); });
  expect_ties_handled([](const Vec3d& p) { return std::floor(p.x) == 0.0 ? 1.0 : 0.0; });
}

int integer_noise(const Vec3d& p, std::uint32_t seed) {
  const auto at = [](double v) { return static_cast<std::int32_t>(std::floor(v + 0.5)); };
  return static_cast<int>(hash_cell(hash_seed(seed, 0), at(p.x), at(p.y), at(p.z)) >> 8);
}

TEST(Mesher, RandomSignsAndCheckerboardsAreClosedManifolds) {
  for (std::uint32_t seed = 0; seed < 6; ++seed) {
    expect_ties_handled([seed](const Vec3d& p) { return integer_noise(p, seed) % 3 - 1.0; });
    expect_ties_handled([seed](const Vec3d& p) { return integer_noise(p, seed) % 2 - 0.5; });
    expect_ties_handled([seed](const Vec3d& p) { return integer_noise(p, seed) % 1000 / 500.0 - 1.0; });
  }
  expect_ties_handled([](const Vec3d& p) {
    const auto at = [](double v) { return static_cast<int>(std::floor(v + 0.5)); };
    return ((at(p.x) + at(p.y) + at(p.z)) & 1) != 0 ? 1.0 : 0.0;
  });
}

TEST(Mesher, ValuesThatAreNotFiniteStayHarmless) {
  constexpr double kInfinity = std::numeric_limits<double>::infinity();
  expect_ties_handled([](const Vec3d& p) { return p.x > 2.0 ? std::nan("") : 5.0 - norm(p); });
  expect_ties_handled([](const Vec3d& p) { return norm(p) < 5.0 ? kInfinity : -kInfinity; });
}

TEST(Mesher, AnEmptyFieldIsAnEmptyMesh) {
  const TriangleMesh mesh = make_mesh(AnalyticField([](const Vec3d&) { return -1.0; }), cube_box(1.0), 32);
  EXPECT_TRUE(mesh.vertices.empty() && mesh.triangles.empty());
}

TEST(Mesher, BrokenPromisesAreErrorsAndNeverHoles) {
  MeshCollector sink;
  // The bounds cut the body; in the second case culling even proves whole blocks at the border full.
  EXPECT_THROW(mesh_field(AnalyticField(unit_sphere), cube_box(0.5), 32, sink), WorkError);
  EXPECT_THROW(mesh_field(make_field(unit_sphere, 1.0), cube_box(0.3), 64, sink), WorkError);
  // A bound that is too tight discards blocks that the surface crosses.
  EXPECT_THROW(mesh_field(make_field(unit_sphere, 0.2), cube_box(1.0), 64, sink), WorkError);
}

TEST(Mesher, BadResolutionsAndBoundsAreInputErrors) {
  MeshCollector sink;
  const auto field = make_field(unit_sphere, 1.0);
  EXPECT_THROW(mesh_field(field, cube_box(1.0), 3, sink), InputError);
  EXPECT_THROW(mesh_field(field, cube_box(1.0), 100000, sink), InputError);
  EXPECT_THROW(mesh_field(field, Box{}, 32, sink), InputError);
  EXPECT_THROW(mesh_field(field, cube_box(0.0), 32, sink), InputError);
  const Box far_away{{1e6, 1e6, 1e6}, {1e6 + 1, 1e6 + 1, 1e6 + 1}};
  EXPECT_THROW(mesh_field(field, far_away, 256, sink), InputError);
  EXPECT_THROW(mesh_patch(field, 0.0, 64, sink), InputError);
  EXPECT_THROW(mesh_patch(field, 1.0, 3, sink), InputError);
}

TEST(Mesher, StopsWhenAsked) {
  MeshCollector sink;
  const Progress stop = [](double fraction, std::string_view) { return fraction < 0.5; };
  EXPECT_THROW(mesh_field(make_field(unit_sphere, 1.0), cube_box(1.0), 64, sink, stop), WorkError);
}

}  // namespace
}  // namespace astrolith
