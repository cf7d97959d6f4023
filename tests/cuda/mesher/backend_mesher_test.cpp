// Compares the GPU's mesher, run on the host thread by thread, with the CPU's mesher.
#include "cuda/mesher/backend_mesher.h"

#include <cstring>
#include <filesystem>

#include "cuda/device.h"
#include "cuda/mesher/gpu_mesher.h"
#include "recipe/recipe_json.h"
#include "synthesis/field/field_mesh.h"
#include "tests/cuda/host_backend.h"
#include "tests/support/test_size.h"
#include "tests/synthesis/bodies.h"
#include "tests/synthesis/exemplars.h"
#include "tests/synthesis/random_recipes.h"

namespace astrolith {
namespace {

using testing::fractal_layer;
using testing::potato_recipe;
using testing::sphere_recipe;

// Two blocks along a side. In the full size there are eight, with cells so small that the GPU can mesh more
// of the examples.
const int kExampleCells = testing::by_size(12, 64);

struct Made {
  MeshStatistics statistics;
  TriangleMesh mesh;
};

Made on_cpu(const ImplicitField& field, int resolution, MeshTile tile = {}) {
  MeshCollector sink;
  const MeshStatistics statistics = mesh_field(field, field.bounds(), resolution, sink, {}, tile);
  return {statistics, std::move(sink.mesh)};
}
Made on_twin(const ImplicitField& field, int resolution, MeshTile tile = {},
             HostBackend backend = HostBackend()) {
  MeshCollector sink;
  const MeshStatistics statistics = mesh_field_on(backend, field, field.bounds(), resolution, sink, {}, tile);
  return {statistics, std::move(sink.mesh)};
}

Made patch_on_cpu(const PatchField& patch, double size, int resolution) {
  MeshCollector sink;
  const MeshStatistics statistics = mesh_patch(patch, size, resolution, sink);
  return {statistics, std::move(sink.mesh)};
}
Made patch_on_twin(const PatchField& patch, double size, int resolution) {
  MeshCollector sink;
  HostBackend backend;
  const MeshStatistics statistics = mesh_patch_on(backend, patch, size, resolution, sink, {});
  return {statistics, std::move(sink.mesh)};
}

template <typename T>
bool same_bytes(const std::vector<T>& a, const std::vector<T>& b) {
  return a.size() == b.size() && (a.empty() || std::memcmp(a.data(), b.data(), a.size() * sizeof(T)) == 0);
}

void expect_same(const Made& twin, const Made& cpu) {
  EXPECT_GT(cpu.mesh.triangles.size(), 30u);
  EXPECT_TRUE(same_bytes(twin.mesh.vertices, cpu.mesh.vertices));
  EXPECT_TRUE(same_bytes(twin.mesh.normals, cpu.mesh.normals));
  EXPECT_TRUE(same_bytes(twin.mesh.triangles, cpu.mesh.triangles));
  EXPECT_EQ(twin.statistics.vertices, cpu.statistics.vertices);
  EXPECT_EQ(twin.statistics.triangles, cpu.statistics.triangles);
  // A backend has other bounds than the CPU, and evaluates F at all samples. Its active blocks and
  // evaluations are others, therefore.
  EXPECT_EQ(twin.statistics.total_blocks, cpu.statistics.total_blocks);
  EXPECT_EQ(twin.statistics.cut_vertices, cpu.statistics.cut_vertices);
}

Recipe asteroid() {
  Recipe recipe = potato_recipe(30, 5);
  SpotLayer spots;
  spots.amplitude = 0.01;
  spots.size = 0.08;
  spots.cell_size = 0.25;
  spots.layers = 2;
  SparseLayer pits;
  pits.amplitude = 0.01;
  pits.cell_size = 0.1;
  recipe.layers = {fractal_layer(0.02, 4.0, 4), spots, pits};
  return recipe;
}

TEST(BackendMesher, MakesTheMeshOfTheCpu) {
  for (const int resolution : {4, 9, 10, 11, 33, 64}) {
    const ImplicitField field(asteroid());
    expect_same(on_twin(field, std::max(resolution, 9)), on_cpu(field, std::max(resolution, 9)));
  }
  const ImplicitField bare(potato_recipe(60, 8));
  expect_same(on_twin(bare, 50), on_cpu(bare, 50));
  Recipe gravel = potato_recipe(10, 8);
  gravel.layers = {testing::gabor_layer(0.06, 0.003)};
  const ImplicitField noisy(gravel);
  ASSERT_EQ(obstacle_on_gpu(noisy.tables(), block_side(field_grid(noisy.bounds(), 12))), "");
  expect_same(on_twin(noisy, 10), on_cpu(noisy, 10));
}

// An exemplar, and an exemplar on layers.
TEST(BackendMesher, MakesTheExemplarsOfTheCpu) {
  const ExemplarLayer exemplar = testing::exemplar_layer(0.01, 0.01);
  for (const std::vector<Layer>& layers :
       {std::vector<Layer>{exemplar}, {fractal_layer(0.1, 4.0, 2), exemplar}}) {
    Recipe recipe = potato_recipe(10, 8);
    recipe.layers = layers;
    const ImplicitField field(recipe);
    ASSERT_EQ(obstacle_on_gpu(field.tables(), block_side(field_grid(field.bounds(), 40))), "");
    expect_same(on_twin(field, 40), on_cpu(field, 40));
  }
}

// The field is exactly zero at some samples, and some cells have many such samples.
TEST(BackendMesher, TreatsTiesAsTheCpu) {
  Recipe recipe = sphere_recipe(1.0);
  recipe.body->spheres.push_back({{2.0, 0.0, 0.0}, 1.0});
  recipe.body->blend_exponent = 1.0;
  const ImplicitField field(recipe);
  for (const int resolution : {16, 18, 34})
    expect_same(on_twin(field, resolution), on_cpu(field, resolution));
}

TEST(BackendMesher, MakesTheTilesOfTheCpu) {
  const ImplicitField field(asteroid());
  for (int i = 0; i < 3; ++i) expect_same(on_twin(field, 50, {i, 3}), on_cpu(field, 50, {i, 3}));
}

// The folder of the examples: in the sources, or beside the programs where scripts/gpu.sh has copied them to
// another computer.
std::filesystem::path examples() {
  const std::filesystem::path sources = ASTROLITH_EXAMPLES;
  return std::filesystem::exists(sources) ? sources : std::filesystem::path("synthesis/examples");
}

// Every example recipe that the GPU can mesh, on a coarse grid.
TEST(BackendMesher, MeshesTheExamplesAsTheCpu) {
  if (!std::filesystem::exists(examples())) GTEST_SKIP() << "the examples are not here";
  int meshed = 0;
  for (const auto& entry : std::filesystem::directory_iterator(examples())) {
    if (entry.path().extension() != ".json") continue;
    const ImplicitField field(read_recipe(entry.path()));
    constexpr double kMostCells = 32768.0;  // more impulses in a block take the twin minutes
    const double side = block_side(field_grid(field.bounds(), kExampleCells));
    if (!obstacle_on_gpu(field.tables(), side, kMostCells).empty()) continue;
    SCOPED_TRACE(entry.path().filename().string());
    expect_same(on_twin(field, kExampleCells), on_cpu(field, kExampleCells));
    ++meshed;
  }
  EXPECT_GE(meshed, testing::by_size(19, 30));
}

// Compares meshes of a cube about the point of the surface in a direction from the origin, along the body's
// axes and along others.
void expect_same_patches(const Recipe& recipe, const Vec3d& direction, double size, int resolution,
                         bool has_patch_layers) {
  const ImplicitField whole(recipe);
  double inside = 0.0, outside = norm(whole.bounds().max) + norm(whole.bounds().min);
  for (int i = 0; i < 60; ++i) {
    const double middle = 0.5 * (inside + outside);
    (whole.inside(middle * direction) ? inside : outside) = middle;
  }
  const Vec3d center = inside * direction;
  const GroundAxes axes = axes_about(direction);
  for (const bool turned : {false, true}) {
    const ImplicitField field(recipe, "recipe", PatchCube{center, turned ? 1.7321 * size : size});
    EXPECT_EQ(field.has_patch_layers(), has_patch_layers);
    const PatchField patch = turned ? PatchField(field, center, axes) : PatchField(field, center);
    ASSERT_EQ(obstacle_on_gpu(field.patch_tables(), block_side(patch_grid(patch.place(), size, resolution))),
              "");
    expect_same(patch_on_twin(patch, size, resolution), patch_on_cpu(patch, size, resolution));
  }
}

// Layers that float coordinates of the body's frame hold.
TEST(BackendMesher, MakesThePatchesOfTheCpu) {
  expect_same_patches(asteroid(), normalized(Vec3d{0.3, -0.5, 0.8}), 0.2, 20, false);
  for (std::uint64_t seed = 1; seed <= 3; ++seed) {
    SCOPED_TRACE(seed);
    expect_same_patches(testing::random_recipe(seed), Vec3d{1, 0, 0}, 0.3, 18, false);
  }
}

// The body is so large that its frame holds no details of the layer.
TEST(BackendMesher, MakesTheFinePatchesOfTheCpu) {
  SpotLayer spots;
  spots.amplitude = 0.05;
  spots.size = 0.1;
  spots.cell_size = 0.25;
  SparseLayer pits;
  pits.amplitude = -0.1;
  pits.cell_size = 0.3;
  FractalLayer warped = fractal_layer(0.1, 3.0, 2);
  warped.warp = Warp{0.1, 1.0, 2, 0.5, 1.95};
  FractalLayer mask = fractal_layer(0.1, 0.5, 3);
  mask.name = "mask";
  spots.use.mask = LayerMask{"mask", -0.05, 0.05};
  for (const std::vector<Layer>& layers :
       {std::vector<Layer>{mask, spots},
        {pits, warped},
        {testing::gabor_layer(0.3, 0.03)},
        {fractal_layer(0.2, 1.0, 2), testing::exemplar_layer(0.02, 0.02)}}) {
    Recipe recipe = sphere_recipe(1e5);
    recipe.body->spheres.push_back({{2e4, 0.0, 0.0}, 9e4});
    recipe.layers = layers;
    expect_same_patches(recipe, normalized(Vec3d{0.3, -0.5, 0.8}), 2.0, 10, true);
    recipe.body->warp = Warp{.amplitude = 200.0, .frequency = 1e-4, .octaves = 2};
    expect_same_patches(recipe, normalized(Vec3d{0.3, -0.5, 0.8}), 2.0, 10, true);
  }
}

// Craters and boulders that are drawn by cells have their places in the frame of the patch.
TEST(BackendMesher, MakesTheLandformsOfPatchesOfTheCpu) {
  Recipe recipe = sphere_recipe(250.0);
  CraterLayer craters;
  Population& pits = craters.population.emplace().drawn;
  pits.density = 0.02;
  pits.least_diameter = 2.0;
  pits.greatest_diameter = 8.0;
  pits.by_cells = true;
  BoulderLayer boulders;
  boulders.roughness = boulders.smoothing = 0.1;
  boulders.population.emplace().drawn = pits;
  boulders.population->drawn.least_diameter = 1.0;
  recipe.layers = {fractal_layer(2.0, 0.01, 4), craters, boulders};
  const Vec3d direction = normalized(Vec3d{0.3, -0.5, 0.8});
  expect_same_patches(recipe, direction, 20.0, 20, true);
  recipe.body->warp = Warp{.amplitude = 3.0, .frequency = 0.01, .octaves = 2};
  expect_same_patches(recipe, direction, 20.0, 12, true);
  BodyOperation& operation = recipe.body->operations.emplace_back();
  operation.operand = {*sphere_recipe(50.0).body};
  expect_same_patches(recipe, direction, 20.0, 12, true);
}

// Threads run at the same time on a GPU, so that their order must not change the bytes.
TEST(BackendMesher, TakesThreadsInAnyOrder) {
  const ImplicitField field(asteroid());
  const Made cpu = on_cpu(field, 33);
  for (const std::size_t seed : {1, 2, 31}) {
    expect_same(on_twin(field, 33, {}, HostBackend(std::size_t{1} << 34, {seed})), cpu);
  }
}

// With less memory, batches are smaller, down to one layer each. The mesh must not change.
TEST(BackendMesher, HalvesTheBatchWhereMemoryEnds) {
  const ImplicitField field(asteroid());
  const Made cpu = on_cpu(field, 50);
  for (const std::size_t megabytes : {12, 8, 5, 4}) {
    expect_same(on_twin(field, 50, {}, HostBackend(megabytes << 20)), cpu);
  }
  EXPECT_THROW(on_twin(field, 50, {}, HostBackend(std::size_t{1} << 19)), WorkError);
}

TEST(BackendMesher, FailsAsTheCpuAtWrongBounds) {
  const ImplicitField field(sphere_recipe(1.0));
  MeshDiscard sink;
  HostBackend backend;
  const Box half{{-2, -2, -2}, {0.1, 2, 2}};
  EXPECT_THROW(mesh_field(field, half, 30, sink), WorkError);
  EXPECT_THROW(mesh_field_on(backend, field, half, 30, sink, {}, {}), WorkError);
}

TEST(MeshFieldOnGpu, MakesThePatchOfTheCpu) {
  const DeviceStatus status = probe_device();
  if (!status.usable) GTEST_SKIP() << "no GPU here: " << status.reason;
  const Recipe recipe = asteroid();
  const Vec3d start = on_cpu(ImplicitField(recipe), 33).mesh.vertices.front();
  const ImplicitField field(recipe, "recipe", PatchCube{start, 0.3});
  const PatchField patch(field, start, axes_about(normalized(start)));
  MeshCollector sink;
  const MeshStatistics statistics = mesh_patch_on_gpu(patch, 0.17, 100, sink);
  expect_same({statistics, std::move(sink.mesh)}, patch_on_cpu(patch, 0.17, 100));
}

TEST(MeshFieldOnGpu, MakesTheMeshOfTheCpu) {
  const DeviceStatus status = probe_device();
  if (!status.usable) GTEST_SKIP() << "no GPU here: " << status.reason;
  const ImplicitField field(asteroid());
  for (const MeshTile tile : {MeshTile{0, 1}, MeshTile{1, 3}}) {
    for (const int resolution : {33, 200}) {
      MeshCollector sink;
      const MeshStatistics statistics = mesh_field_on_gpu(field, field.bounds(), resolution, sink, {}, tile);
      expect_same({statistics, std::move(sink.mesh)}, on_cpu(field, resolution, tile));
    }
  }
}

}  // namespace
}  // namespace astrolith
