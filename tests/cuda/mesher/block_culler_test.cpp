// Compares the blocks that a backend finds, and the lists of the elements that reach them, with those of the
// CPU. The CPU has other bounds, so that few blocks that the surface does not cross are found by one alone.
#include "cuda/mesher/gathered_lists.h"

#include <algorithm>
#include <array>
#include <cstring>
#include <iterator>

#include "synthesis/field/implicit_field.h"
#include "synthesis/mesh/mesher.h"
#include "tests/cuda/host_backend.h"
#include "tests/synthesis/block_lists.h"
#include "tests/synthesis/random_recipes.h"

namespace astrolith {
namespace {

using testing::random_recipe;

// A block by its place: layer, y and x.
using Place = std::array<int, 3>;

// The mixed blocks of all layers, sorted.
std::vector<Place> cpu_blocks(const ImplicitField& field, const MeshGrid& grid) {
  const FieldBlock whole = field.gather(grid.samples.box({0, 0, 0}, grid.samples.cells, grid.samples.step));
  std::vector<Place> all;
  for (int z = 0; z < grid.blocks(2); ++z) {
    for (const auto& node : mixed_blocks(grid, whole, z)) all.push_back({z, node.y, node.x});
  }
  return all;
}

template <typename T>
void expect_same(const std::vector<T>& cpu, const T* twin, const char* what) {
  EXPECT_TRUE(cpu.empty() || std::memcmp(cpu.data(), twin, cpu.size() * sizeof(T)) == 0) << what;
}

void expect_same_lists(const BlockListStore& cpu, const BlockListArrays& twin) {
  expect_same(cpu.first_metaball, twin.first_metaball, "metaballs");
  expect_same(cpu.metaballs, twin.metaballs, "metaballs");
  expect_same(cpu.first_spot, twin.first_spot, "spots");
  expect_same(cpu.spots, twin.spots, "spots");
  expect_same(cpu.first_gabor, twin.first_gabor, "Gabor impulses");
  expect_same(cpu.gabor, twin.gabor, "Gabor impulses");
  expect_same(cpu.first_landform, twin.first_landform, "craters and boulders");
  expect_same(cpu.landforms, twin.landforms, "craters and boulders");
}

void expect_same_blocks(const Recipe& recipe, int resolution, const HostOrder& order) {
  const ImplicitField field(recipe);
  const MeshGrid grid = field_grid(field.bounds(), resolution);
  const std::vector<Place> cpu = cpu_blocks(field, grid);

  HostBackend backend(std::size_t{1} << 34, order);
  const FieldOnBackend<HostBackend> on_backend(backend, field.tables());
  BlockCuller<HostBackend> culler(backend, field.tables(), on_backend.view(), grid,
                                  gabor_margin(field.tables()));
  auto failure = zeros_on<std::uint32_t>(backend, 1);
  const CulledBlocks<HostBackend> twin = culler.cull(0, grid.blocks(2), failure);
  ASSERT_EQ(backend.read(failure, 0), 0u);
  std::vector<Place> found;
  for (const auto& block : twin.on_host) found.push_back({block.z, block.y, block.x});
  ASSERT_TRUE(std::is_sorted(found.begin(), found.end()));
  std::vector<Place> both;
  std::set_intersection(found.begin(), found.end(), cpu.begin(), cpu.end(), std::back_inserter(both));
  EXPECT_GT(double(both.size()), 0.9 * double(std::max(found.size(), cpu.size())));
  const GatheredLists<HostBackend> gathered(backend, {on_backend.view(), grid, culler.lists(), twin.view()},
                                            found.size());
  BlockListStore lists(field.tables());
  for (const auto& [z, y, x] : found) lists.add(field.tables(), grid.box(x, y, z, 1));
  expect_same_lists(lists, gathered.view());
}

TEST(BlockCuller, FindsTheBlocksAndListsOfTheCpu) {
  for (std::uint64_t seed = 1; seed <= 8; ++seed) {
    SCOPED_TRACE(seed);
    expect_same_blocks(random_recipe(seed), 18, {});
  }
}

// Blocks outside the supports of all kernels, kept because a boulder reaches them, still get the metaballs
// that the frames of their Gabor impulses follow from.
TEST(BlockCuller, FindsTheListsBeyondTheSupports) {
  Recipe recipe = testing::sphere_recipe(1.0);
  recipe.body->cutoff_radii = 1.3;
  BoulderLayer boulders;
  boulders.boulders.push_back({{{1, 0, 0}, true}, {1.8, 1.8, 1.8}, 0.0, 0.0, 0.05});
  recipe.layers = {testing::gabor_layer(0.06, 0.003), boulders};
  expect_same_blocks(recipe, 24, {});
}

TEST(BlockCuller, TakesThreadsInAnyOrder) {
  for (const std::size_t order : {1, 7}) expect_same_blocks(random_recipe(3), 30, {order});
}

// A body that fills the border of the grid is refused, as it is by the CPU.
TEST(BlockCuller, SaysWhereTheBodyFillsTheBorder) {
  const ImplicitField field(testing::sphere_recipe(1.0));
  const MeshGrid grid = field_grid({{-0.2, -0.2, -0.2}, {0.2, 0.2, 0.2}}, 40);
  HostBackend backend;
  const FieldOnBackend<HostBackend> on_backend(backend, field.tables());
  BlockCuller<HostBackend> culler(backend, field.tables(), on_backend.view(), grid, 0.0);
  auto failure = zeros_on<std::uint32_t>(backend, 1);
  culler.cull(0, grid.blocks(2), failure);
  EXPECT_EQ(backend.read(failure, 0), static_cast<std::uint32_t>(MeshFailure::kBorder));
}

}  // namespace
}  // namespace astrolith
