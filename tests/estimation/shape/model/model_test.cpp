#include "estimation/shape/model/block_kernels.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numeric>

#include "estimation/shape/model/metaball_model.h"
#include "estimation/shape/model/model_evaluation_internal.h"
#include "numerics/hash_random.h"
#include "synthesis/body/metaball_body.h"

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

// The model after parameter `which` of sphere `i` has grown by h: 0 to 2 is the centre, 3 the log radius.
// With i = -1 the log sharpness grows.
MetaballModel nudged(MetaballModel model, int i, int which, double h) {
  if (i < 0) {
    model.sharpness *= std::exp(h);
    return model;
  }
  Sphere& s = model.spheres[static_cast<std::size_t>(i)];
  if (which == 0) s.center.x += h;
  if (which == 1) s.center.y += h;
  if (which == 2) s.center.z += h;
  if (which == 3) s.radius *= std::exp(h);
  return model;
}

// Blocks that are not full have lanes without points.
class BlockKernelsOfPoints : public ::testing::TestWithParam<int> {
 protected:
  // Distances or levels at all points. The cut-off and the gradient floor are those of model_, because the
  // derivatives treat them as constant.
  std::vector<double> values(const MetaballModel& model, bool distance,
                             std::vector<BlockKernels::Slopes>& slopes) {
    ModelEvaluation evaluation = evaluation_parameters(model);
    evaluation.cutoff_squared = fixed_.cutoff_squared;
    evaluation.gradient_floor = fixed_.gradient_floor;
    kernels_.evaluate(model, evaluation, all_, points_);
    std::vector<double> found;
    slopes.resize(points_.size());
    for (std::size_t j = 0; j < points_.size(); ++j) {
      const MetaballTotals<double> totals = kernels_.totals(j);
      found.push_back(distance ? distance_with_slopes(model, evaluation, totals, slopes[j])
                               : level_with_slopes(model, totals, slopes[j]));
    }
    return found;
  }
  std::vector<double> differences(bool distance, int i, int which) {
    constexpr double kStep = 1e-5;
    std::vector<BlockKernels::Slopes> unused;
    std::vector<double> more = values(nudged(model_, i, which, kStep), distance, unused);
    const std::vector<double> less = values(nudged(model_, i, which, -kStep), distance, unused);
    for (std::size_t j = 0; j < more.size(); ++j) more[j] = (more[j] - less[j]) / (2 * kStep);
    return more;
  }

  const MetaballModel model_ = scattered_model(30, 0.2, 0.7);
  const ModelEvaluation fixed_ = evaluation_parameters(model_);
  const std::vector<Vec3d> points_ = scattered_points(GetParam());
  const std::vector<std::int32_t> all_ = [] {
    std::vector<std::int32_t> all(30);
    std::iota(all.begin(), all.end(), 0);
    return all;
  }();
  BlockKernels kernels_;
};

TEST_P(BlockKernelsOfPoints, DerivativesAgreeWithDifferences) {
  const std::vector<std::int32_t> selected{0, 2, 5, 17, 29};
  const std::vector<std::size_t> columns{0, 1, 3, 4, 5};  // column 2 stays
  const auto tolerance = [](double value) { return 1e-6 * (1.0 + std::abs(value)); };
  for (const bool distance : {true, false}) {
    std::vector<BlockKernels::Slopes> slopes;
    values(model_, distance, slopes);
    for (BlockKernels::Slopes& s : slopes) s.scale(3.0);
    std::vector<SphereDerivatives> by_sphere(6 * points_.size(), SphereDerivatives{7, 7, 7, 7});
    std::vector<double> by_sharpness(points_.size());
    kernels_.differentiate(slopes, {selected, columns, 6}, by_sphere.data(), by_sharpness);
    for (std::size_t j = 0; j < points_.size(); ++j) {
      EXPECT_EQ(by_sphere[6 * j + 2], (SphereDerivatives{7, 7, 7, 7}));
      const double expected = 3.0 * differences(distance, -1, 0)[j];
      EXPECT_NEAR(by_sharpness[j], expected, tolerance(expected));
    }
    for (std::size_t k = 0; k < selected.size(); ++k) {
      for (int which = 0; which < 4; ++which) {
        const std::vector<double> found = differences(distance, selected[k], which);
        for (std::size_t j = 0; j < points_.size(); ++j) {
          EXPECT_NEAR(by_sphere[6 * j + columns[k]][static_cast<std::size_t>(which)], 3.0 * found[j],
                      tolerance(3.0 * found[j]))
              << "sphere " << selected[k] << ", parameter " << which;
        }
      }
    }
  }
}

INSTANTIATE_TEST_SUITE_P(Points, BlockKernelsOfPoints, ::testing::Values(1, 7, 24));

TEST(BlockKernels, TheModelIsTheBodyThatSynthesisMakes) {
  const MetaballModel model = scattered_model(9, 0.3, 0.9);
  const PreparedMetaballs body = prepare_metaballs(metaball_body(model));
  const std::vector<Vec3d> points = scattered_points(100);
  const std::vector<double> distances = model_distances(model, points);
  for (std::size_t j = 0; j < points.size(); ++j) {
    const auto x = static_cast<float>(points[j].x), y = static_cast<float>(points[j].y),
               z = static_cast<float>(points[j].z);
    float s = 0, gx = 0, gy = 0, gz = 0;
    evaluate_metaballs(body, 1, &x, &y, &z, &s, &gx, &gy, &gz);
    EXPECT_NEAR(distances[j], s, 1e-4 * (1.0 + std::abs(distances[j])));
  }
}

TEST(BlockKernels, ALoneSphereHasItsRadius) {
  const MetaballModel model{4.0, {{{1, 2, 3}, 2.0}}};
  EXPECT_NEAR(model_distances(model, std::vector<Vec3d>{{1, 2, 5}})[0], 0.0, 1e-12);
  EXPECT_NEAR(model_levels(model, std::vector<Vec3d>{{1, 2, 3}})[0], 1.0, 1e-11);
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
