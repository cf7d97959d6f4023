#include "tests/benchmarks/volume/volume_mesher.h"

#include <gtest/gtest.h>

#include <cmath>
#include <vector>

#include "geometry/mesh_topology.h"
#include "numerics/errors.h"
#include "numerics/hash_random.h"
#include "numerics/parallel_for.h"
#include "synthesis/mesh/mesher.h"
#include "tests/synthesis/analytic_field.h"

namespace astrolith {
namespace {

double gyroid_ball(const Vec3d& p) {
  const double gyroid = std::sin(5 * p.x) * std::cos(5 * p.y) + std::sin(5 * p.y) * std::cos(5 * p.z) +
                        std::sin(5 * p.z) * std::cos(5 * p.x);
  return 0.8 - norm(p) + 0.2 * gyroid;
}

std::vector<float> samples_of(const SampleGrid& grid, double (*field)(const Vec3d&)) {
  std::vector<float> values;
  for (int z = 0; z <= grid.cells[2]; ++z) {
    for (int y = 0; y <= grid.cells[1]; ++y) {
      for (int x = 0; x <= grid.cells[0]; ++x) {
        values.push_back(static_cast<float>(field({grid.x(x), grid.y(y), grid.z(z)})));
      }
    }
  }
  return values;
}

TriangleMesh mesh_of(const SampleGrid& grid, const std::vector<float>& values) {
  MeshCollector collector;
  const VolumeMeshSize size = mesh_volume(grid, values, collector);
  EXPECT_EQ(size.vertices, static_cast<std::int64_t>(collector.mesh.vertices.size()));
  EXPECT_EQ(size.triangles, static_cast<std::int64_t>(collector.mesh.triangles.size()));
  return std::move(collector.mesh);
}

// Rows shorter than a word, as long as one, and longer; last slabs and groups of rows that are whole or not.
TEST(VolumeMesher, MakesTheMeshOfTheSameField) {
  for (const int resolution : {9, 31, 63, 64, 130}) {
    const Box bounds{{-1.4, -1.4, -1.4}, {1.4, 1.4, 1.4}};
    MeshCollector blocks;
    mesh_field(testing::AnalyticField(gyroid_ball), bounds, resolution, blocks);
    const SampleGrid grid = make_sample_grid(bounds, resolution);
    const TriangleMesh mesh = mesh_of(grid, samples_of(grid, gyroid_ball));
    ASSERT_EQ(mesh.vertices, blocks.mesh.vertices);
    ASSERT_EQ(mesh.triangles, blocks.mesh.triangles);
    if (resolution < 60) continue;  // normals of coarser cells have little to do with each other
    for (std::size_t i = 0; i < mesh.normals.size(); ++i) {
      ASSERT_GT(dot(mesh.normals[i], blocks.mesh.normals[i]), 0.9);
    }
  }
}

// Boxes of unequal sides, filled with noise in which every sign pattern and ties at the level occur.
TEST(VolumeMesher, NoiseBecomesAClosedManifoldForAnyThreads) {
  CounterRandom random(3);
  for (const std::array<int, 3> cells : {std::array{40, 7, 9}, {5, 40, 6}, {66, 5, 33}, {2, 2, 2}}) {
    const SampleGrid grid{{}, 1.0, cells};
    std::vector<float> values;
    for (int z = 0; z <= cells[2]; ++z) {
      for (int y = 0; y <= cells[1]; ++y) {
        for (int x = 0; x <= cells[0]; ++x) {
          const bool border = x == 0 || y == 0 || z == 0 || x == cells[0] || y == cells[1] || z == cells[2];
          values.push_back(border ? -1.0f : static_cast<float>(random.below(3)) - 1.0f);
        }
      }
    }
    values[static_cast<std::size_t>(((cells[1] + 1) + 1) * (cells[0] + 1) + 1)] = 1.0f;
    const TriangleMesh mesh = mesh_of(grid, values);
    const MeshTopology topology = analyze_topology(mesh);
    EXPECT_TRUE(topology.closed && topology.manifold && topology.oriented);
    EXPECT_EQ(topology.unused_vertices, 0);
    const ThreadLimit one(1);
    const TriangleMesh alone = mesh_of(grid, values);
    EXPECT_TRUE(alone.vertices == mesh.vertices && alone.triangles == mesh.triangles);
  }
}

TEST(VolumeMesher, RefusesWhatIsNoVolume) {
  MeshDiscard sink;
  const SampleGrid grid{{}, 1.0, {3, 3, 3}};
  std::vector<float> values(64, -1.0f);
  EXPECT_EQ(mesh_volume(grid, values, sink).triangles, 0);
  EXPECT_THROW(mesh_volume(grid, std::span(values).first(63), sink), InputError);
  EXPECT_THROW(mesh_volume({{}, 1.0, {1, 3, 3}}, std::span(values).first(32), sink), InputError);
  for (const std::size_t border : {0u, 21u, 22u, 27u, 36u, 63u}) {  // corners, sides and faces
    values.assign(64, -1.0f);
    values[border] = 1.0f;
    if (border == 21 || border == 22) {
      EXPECT_EQ(mesh_volume(grid, values, sink).triangles, 8);
    } else {
      EXPECT_THROW(mesh_volume(grid, values, sink), InputError) << border;
    }
  }
}

}  // namespace
}  // namespace astrolith
