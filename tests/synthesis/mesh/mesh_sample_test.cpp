#include "synthesis/mesh/mesh_sample.h"

#include "synthesis/field/field_mesh.h"
#include "synthesis/field/implicit_field.h"
#include "tests/synthesis/bodies.h"

namespace astrolith {
namespace {

MeshStatistics statistics_at(const ImplicitField& field, int resolution) {
  MeshDiscard sink;
  return mesh_field(field, field.bounds(), resolution, sink);
}

MeshEstimate sampled(const ImplicitField& field, int resolution, const SampleSize& size, MeshTile tile = {}) {
  return sample_field(field, field.bounds(), resolution, tile, size);
}

void expect_near(double estimate, std::int64_t made, double tolerance) {
  EXPECT_NEAR(estimate / static_cast<double>(made), 1.0, tolerance);
}

TEST(MeshSample, AWholeSampleIsExact) {
  const ImplicitField field(testing::potato_recipe(20, 3));
  const MeshStatistics made = statistics_at(field, 60);
  const MeshEstimate estimate = sampled(field, 60, {1 << 20, 1 << 20});
  EXPECT_TRUE(estimate.whole);
  EXPECT_EQ(estimate.blocks, static_cast<double>(made.active_blocks));
  EXPECT_EQ(estimate.triangles, static_cast<double>(made.triangles));
  EXPECT_EQ(estimate.vertices, static_cast<double>(made.vertices));
  expect_near(estimate.evaluations, made.evaluations, 0.1);
}

TEST(MeshSample, AFewBlocksStandForAll) {
  const ImplicitField field(testing::potato_recipe(20, 3));
  for (const int resolution : {100, 300}) {
    const MeshStatistics made = statistics_at(field, resolution);
    const MeshEstimate estimate = sampled(field, resolution, {256, 256});
    EXPECT_FALSE(estimate.whole);
    expect_near(estimate.blocks, made.active_blocks, 0.1);
    expect_near(estimate.triangles, made.triangles, 0.1);
    expect_near(estimate.evaluations, made.evaluations, 0.1);
    EXPECT_GT(estimate.seconds, 0.0);
  }
}

TEST(MeshSample, ATileIsEstimatedAlone) {
  const ImplicitField field(testing::potato_recipe(20, 3));
  MeshDiscard sink;
  const MeshTile tile{1, 3};
  const MeshStatistics made = mesh_field(field, field.bounds(), 90, sink, {}, tile);
  EXPECT_EQ(sampled(field, 90, {1 << 20, 1 << 20}, tile).triangles, static_cast<double>(made.triangles));
}

// One flat side of a body lies in one layer of blocks, and no other layer has as many.
TEST(MeshSample, TheFullestLayerIsFound) {
  EXPECT_EQ(most_in_layers({1, 2, 90, 3, 4}, {50, 200, 900, 300, 400}, 1), 90.0);
  EXPECT_EQ(most_in_layers({1, 2, 90, 3, 4}, {50, 200, 900, 300, 400}, 3), 97.0);
  EXPECT_DOUBLE_EQ(most_in_layers({10, 0, 20, 0}, {1, 0, 2, 0}, 1), 7.5) << "few samples are averaged";
}

TEST(MeshSample, ChosenItemsAreSpreadEvenly) {
  const std::vector<std::size_t> all = evenly_chosen(5, 9, 1), some = evenly_chosen(1000, 10, 1);
  EXPECT_EQ(all, (std::vector<std::size_t>{0, 1, 2, 3, 4}));
  ASSERT_EQ(some.size(), 10u);
  for (std::size_t i = 1; i < some.size(); ++i) EXPECT_NEAR(double(some[i] - some[i - 1]), 100.0, 1.0);
}

}  // namespace
}  // namespace astrolith
