#include <numeric>

#include "estimation/shape/model/block_kernels.h"
#include "estimation/shape/model/field_derivatives.h"
#include "estimation/shape/model/model_evaluation_internal.h"
#include "estimation/shape/model/model_levels.h"
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

MetaballModel random_model(std::uint64_t seed, int count, double sharpness,
                           Kernel kernel = Kernel::kGaussian) {
  CounterRandom random(seed);
  MetaballModel model{sharpness, {}, kernel};
  for (int i = 0; i < count; ++i) {
    const double x = random.uniform(-1, 1), y = random.uniform(-1, 1), z = random.uniform(-1, 1);
    model.spheres.push_back({{x, y, z}, random.uniform(0.3, 0.9)});
  }
  return model;
}

// Makes every third metaball subtractive.
MetaballModel with_subtractive(MetaballModel model) {
  for (std::size_t i = 2; i < model.spheres.size(); i += 3) model.spheres[i].subtractive = true;
  return model;
}

std::vector<std::int32_t> all_of(const MetaballModel& model) {
  std::vector<std::int32_t> indices(model.spheres.size());
  std::iota(indices.begin(), indices.end(), 0);
  return indices;
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

using Function = double (*)(const MetaballModel&, const ModelEvaluation&, std::span<const std::int32_t>,
                            const Vec3d&, std::span<SphereDerivatives>, double*);

// Compares every derivative with a central difference. The cut-off and the gradient floor are held fixed,
// because the derivatives treat them as constant.
void check_derivatives(Function function, const MetaballModel& model, const Vec3d& p) {
  const auto neighbours = all_of(model);
  const ModelEvaluation fixed = evaluation_parameters(model);
  std::vector<SphereDerivatives> by_sphere(neighbours.size());
  double by_log_sharpness = 0;
  function(model, fixed, neighbours, p, by_sphere, &by_log_sharpness);
  const auto difference = [&](int i, int which) {
    const double h = 1e-5;
    const auto value = [&](double step) {
      const MetaballModel moved = nudged(model, i, which, step);
      ModelEvaluation parameters = evaluation_parameters(moved);
      parameters.cutoff_squared = fixed.cutoff_squared;
      parameters.gradient_floor = fixed.gradient_floor;
      return function(moved, parameters, neighbours, p, {}, nullptr);
    };
    return (value(h) - value(-h)) / (2 * h);
  };
  const auto tolerance = [](double value) { return 1e-7 * (1.0 + std::abs(value)); };
  EXPECT_NEAR(by_log_sharpness, difference(-1, 0), tolerance(by_log_sharpness));
  for (int i = 0; i < static_cast<int>(model.spheres.size()); ++i) {
    for (int which = 0; which < 4; ++which) {
      const double derivative = by_sphere[static_cast<std::size_t>(i)][static_cast<std::size_t>(which)];
      EXPECT_NEAR(derivative, difference(i, which), tolerance(derivative))
          << "sphere " << i << ", parameter " << which;
    }
  }
}

class FieldDerivatives : public ::testing::TestWithParam<Kernel> {};

void check_at_random_points(const MetaballModel& model) {
  CounterRandom random(11);
  for (int k = 0; k < 20; ++k) {
    const double x = random.uniform(-1.2, 1.2), y = random.uniform(-1.2, 1.2), z = random.uniform(-1.2, 1.2);
    const double level =
        level_with_derivatives(model, evaluation_parameters(model), all_of(model), {x, y, z}, {}, nullptr);
    // The kernel floor dominates such a sum.
    if (model.spheres[2].subtractive && model.sharpness * level < -8.0) continue;
    check_derivatives(level_with_derivatives, model, {x, y, z});
    check_derivatives(distance_with_derivatives, model, {x, y, z});
  }
}

TEST_P(FieldDerivatives, DistanceAndLevelAgreeWithDifferences) {
  for (const double sharpness : {0.7, 2.0, 9.0}) {
    check_at_random_points(random_model(3, 6, sharpness, GetParam()));
    if (GetParam() != Kernel::kGaussian) continue;
    check_at_random_points(with_subtractive(random_model(3, 9, sharpness)));
  }
}

TEST(FieldDerivativesWithSubtractive, TheModelIsTheBodyThatSynthesisMakes) {
  const MetaballModel model = with_subtractive(random_model(3, 9, 2.0));
  const PreparedMetaballs body = prepare_metaballs(metaball_body(model));
  const ModelEvaluation parameters = evaluation_parameters(model);
  const auto neighbours = all_of(model);
  CounterRandom random(7);
  for (int k = 0; k < 100; ++k) {
    const auto x = static_cast<float>(random.uniform(-1, 1)), y = static_cast<float>(random.uniform(-1, 1)),
               z = static_cast<float>(random.uniform(-1, 1));
    float s = 0, gx = 0, gy = 0, gz = 0;
    evaluate_metaballs(body, 1, &x, &y, &z, &s, &gx, &gy, &gz);
    const double fitted = distance_with_derivatives(model, parameters, neighbours, {x, y, z}, {}, nullptr);
    EXPECT_NEAR(fitted, s, 1e-4 * (1.0 + std::abs(fitted)));
  }
}

TEST_P(FieldDerivatives, LoneSphereHasItsRadius) {
  const MetaballModel model{4.0, {{{1, 2, 3}, 2.0}}, GetParam()};
  const auto neighbours = all_of(model);
  const auto parameters = evaluation_parameters(model);
  const double s = distance_with_derivatives(model, parameters, neighbours, {1, 2, 5}, {}, nullptr);
  EXPECT_NEAR(s, 0.0, 1e-12);
  const double level = level_with_derivatives(model, parameters, neighbours, {1, 2, 3}, {}, nullptr);
  EXPECT_NEAR(level, GetParam() == Kernel::kGaussian ? 1.0 : std::exp(4.0) - 1.0, 1e-11);
}

INSTANTIATE_TEST_SUITE_P(Kernels, FieldDerivatives, ::testing::ValuesIn(kKernels));

}  // namespace
}  // namespace astrolith
