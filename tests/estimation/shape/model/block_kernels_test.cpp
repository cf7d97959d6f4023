#include "estimation/shape/model/block_kernels.h"

#include <gtest/gtest.h>

#include "estimation/shape/model/field_derivatives.h"
#include "estimation/shape/model/model_evaluation_internal.h"
#include "estimation/shape/model/model_levels.h"
#include "numerics/hash_random.h"

namespace astrolith {
namespace {

MetaballModel scattered_model(int count, double smallest, double largest) {
  CounterRandom random(17);
  MetaballModel model{2.5, {}};
  for (int i = 0; i < count; ++i) {
    const double x = random.uniform(-1, 1), y = random.uniform(-1, 1), z = random.uniform(-1, 1);
    model.spheres.push_back({{x, y, z}, random.uniform(smallest, largest), i % 3 == 2});
  }
  return model;
}

std::vector<Vec3d> scattered_points(int count) {
  CounterRandom random(4);
  std::vector<Vec3d> points;
  for (int i = 0; i < count; ++i) {
    const double x = random.uniform(-1, 1), y = random.uniform(-1, 1), z = random.uniform(-1, 1);
    points.push_back({x, y, z});
  }
  return points;
}

void expect_close(const SphereDerivatives& a, const SphereDerivatives& b) {
  for (std::size_t k = 0; k < 4; ++k) EXPECT_NEAR(a[k], b[k], 1e-11 * (1.0 + std::abs(b[k])));
}

// Blocks that are not full have lanes without points.
class BlockKernelsOfPoints : public ::testing::TestWithParam<int> {};

TEST_P(BlockKernelsOfPoints, AgreeWithOnePointAtATime) {
  const MetaballModel model = scattered_model(30, 0.2, 0.7);
  const ModelEvaluation evaluation = evaluation_parameters(model);
  const std::vector<Vec3d> points = scattered_points(GetParam());
  std::vector<std::int32_t> all(30);
  for (int i = 0; i < 30; ++i) all[static_cast<std::size_t>(i)] = i;
  BlockKernels kernels;
  kernels.evaluate(model, evaluation, all, points);

  const std::vector<std::int32_t> selected{0, 2, 5, 17, 29};
  const std::vector<std::size_t> columns{0, 1, 3, 4, 5};  // column 2 stays
  for (const bool distance : {true, false}) {
    std::vector<BlockKernels::Slopes> slopes(points.size());
    std::vector<SphereDerivatives> by_sphere(6 * points.size(), SphereDerivatives{7, 7, 7, 7}), row(30);
    std::vector<double> values(points.size()), by_sharpness(points.size());
    for (std::size_t j = 0; j < points.size(); ++j) {
      values[j] = distance ? distance_with_slopes(model, evaluation, kernels.totals(j), slopes[j])
                           : level_with_slopes(model, kernels.totals(j), slopes[j]);
      slopes[j].scale(3.0);
    }
    kernels.differentiate(slopes, {selected, columns, 6}, by_sphere.data(), by_sharpness);
    const auto function = distance ? distance_with_derivatives : level_with_derivatives;
    for (std::size_t j = 0; j < points.size(); ++j) {
      double by_log_sharpness = 0.0;
      const double value = function(model, evaluation, all, points[j], row, &by_log_sharpness);
      EXPECT_NEAR(values[j], value, 1e-12 * (1.0 + std::abs(value)));
      EXPECT_NEAR(by_sharpness[j], 3.0 * by_log_sharpness, 1e-10 * (1.0 + std::abs(by_log_sharpness)));
      for (std::size_t k = 0; k < selected.size(); ++k) {
        SphereDerivatives expected = row[static_cast<std::size_t>(selected[k])];
        for (double& by : expected) by *= 3.0;
        expect_close(by_sphere[6 * j + columns[k]], expected);
      }
      expect_close(by_sphere[6 * j + 2], {7, 7, 7, 7});
    }
  }
}

INSTANTIATE_TEST_SUITE_P(Points, BlockKernelsOfPoints, ::testing::Values(1, 7, 24));

TEST(BlockKernels, OtherKernelsAgreeWithOnePointAtATime) {
  for (const Kernel kernel : kKernels) {
    MetaballModel model = scattered_model(20, 0.3, 0.8);
    model.kernel = kernel;
    for (ModelSphere& s : model.spheres) s.subtractive = false;
    const std::vector<Vec3d> points = scattered_points(100);
    const std::vector<double> distances = model_distances(model, points),
                              levels = model_levels(model, points);
    std::vector<std::int32_t> all(20);
    for (int i = 0; i < 20; ++i) all[static_cast<std::size_t>(i)] = i;
    const ModelEvaluation evaluation = evaluation_parameters(model);
    for (std::size_t j = 0; j < points.size(); ++j) {
      const double s = distance_with_derivatives(model, evaluation, all, points[j], {}, nullptr);
      EXPECT_NEAR(distances[j], s, 1e-11 * (1.0 + std::abs(s)));
      const double level = level_with_derivatives(model, evaluation, all, points[j], {}, nullptr);
      EXPECT_NEAR(levels[j], level, 1e-11 * (1.0 + std::abs(level)));
    }
  }
}

TEST(ClusterGroups, FindEverySphereThatReachesACluster) {
  const MetaballModel model = scattered_model(400, 0.01, 0.1);
  const std::vector<Vec3d> points = scattered_points(5000);
  const std::vector<PointCluster> clusters = cluster_points(points, 24);
  const double reach = support_radii(model);
  std::vector<int> visits(clusters.size(), 0);
  for_each_cluster(model, clusters, group_clusters(clusters, 16), reach,
                   [&](std::size_t c, const ClusterScratch& scratch) {
                     std::vector<std::int32_t> expected;
                     find_spheres(model, reach, clusters[c].center, clusters[c].radius, expected);
                     EXPECT_EQ(scratch.spheres, expected);
                     ++visits[c];
                   });
  EXPECT_EQ(visits, std::vector<int>(clusters.size(), 1));
}

TEST(PointClusters, AreNearlyFullAndHoldEveryPointOnce) {
  const std::vector<Vec3d> points = scattered_points(1000);
  const std::vector<PointCluster> clusters = cluster_points(points, 24);
  EXPECT_EQ(clusters.size(), 42u);  // 1000 / 24 = 41.7
  std::vector<int> found(points.size(), 0);
  for (const PointCluster& cluster : clusters) {
    EXPECT_LE(cluster.points.size(), 24u);
    EXPECT_GE(cluster.points.size(), 22u);
    for (const std::int32_t i : cluster.points) {
      ++found[static_cast<std::size_t>(i)];
      EXPECT_LE(norm(points[static_cast<std::size_t>(i)] - cluster.center), cluster.radius);
    }
  }
  EXPECT_EQ(found, std::vector<int>(points.size(), 1));
}

}  // namespace
}  // namespace astrolith
