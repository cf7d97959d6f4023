#include <Eigen/Dense>
#include <array>
#include <cmath>
#include <numbers>

#include "estimation/shape/refinement/normal_equations_internal.h"
#include "estimation/shape/refinement/refinement.h"
#include "numerics/hash_random.h"
#include "numerics/parallel_for.h"
#include "tests/support/meshes.h"

namespace astrolith {
namespace {

// Evenly spaced points on a sphere (golden spiral).
std::vector<Vec3d> points_on_sphere(int n, double radius, const Vec3d& center) {
  std::vector<Vec3d> points;
  for (int i = 0; i < n; ++i) {
    const double z = 1.0 - (2.0 * i + 1.0) / n;
    const double ring = std::sqrt(1.0 - z * z);
    const double angle = i * std::numbers::pi * (3.0 - std::sqrt(5.0));
    points.push_back(center + radius * Vec3d{ring * std::cos(angle), ring * std::sin(angle), z});
  }
  return points;
}

RefinementOptions options() {
  RefinementOptions o;
  o.max_iterations = 60;
  o.loss_scale = 0.05;
  o.containment_weight = 0.1;
  o.relative_decrease = 1e-10;
  return o;
}

TEST(Refinement, OneSphereFindsItsPlaceAndRadius) {
  const FitPoints points{points_on_sphere(300, 1.5, {0.3, -0.2, 0.1}), {}, {}};
  const RefinementSummary summary = refine({3.0, {{{0, 0, 0}, 1.0}}}, points, options());
  ASSERT_EQ(summary.model.spheres.size(), 1u);
  EXPECT_NEAR(summary.model.spheres[0].radius, 1.5, 1e-6);
  EXPECT_NEAR(norm(summary.model.spheres[0].center - Vec3d{0.3, -0.2, 0.1}), 0.0, 1e-6);
  EXPECT_LT(summary.final_cost, 1e-10);
}

TEST(Refinement, OutsidePointsDriveAnIslandAway) {
  FitPoints points{points_on_sphere(300, 1.0, {0, 0, 0}), {}, {}};
  const Vec3d island{2.5, 0, 0};
  for (const double r : {0.1, 0.3, 0.45}) {
    for (const Vec3d& p : points_on_sphere(40, r, island)) points.outside.push_back(p);
  }
  points.outside.push_back(island);
  RefinementOptions o = options();
  o.containment_weight = 1.0;
  const RefinementSummary summary = refine({3.0, {{{0, 0, 0}, 1.0}, {island, 0.4}}}, points, o);
  const auto parameters = evaluation_parameters(summary.model);
  MetaballSums<double> sums;
  for (const Sphere& s : summary.model.spheres) {
    accumulate_metaball(parameters, MetaballSphere<double>{s.center, 1 / (s.radius * s.radius)}, island,
                        sums);
  }
  EXPECT_LT(metaball_distance(parameters, sums).distance, 0.0);
}

TEST(Refinement, SameBitsForOneAndTwoThreads) {
  const FitPoints points{points_on_sphere(500, 1.0, {0, 0, 0}), points_on_sphere(60, 0.5, {0, 0, 0}), {}};
  const MetaballModel start{3.0, {{{0.3, 0, 0}, 0.8}, {{-0.3, 0.1, 0}, 0.8}, {{0, 0, 0.3}, 0.7}}};
  std::vector<MetaballModel> models;
  for (const int threads : {1, 2}) {
    const ThreadLimit limit(threads);
    models.push_back(refine(start, points, options()).model);
  }
  EXPECT_EQ(models[0].sharpness, models[1].sharpness);
  for (std::size_t i = 0; i < start.spheres.size(); ++i) {
    EXPECT_EQ(models[0].spheres[i].center, models[1].spheres[i].center);
    EXPECT_EQ(models[0].spheres[i].radius, models[1].spheres[i].radius);
  }
}

TEST(Refinement, StopsWhenAskedAndKeepsTheBest) {
  const FitPoints points{points_on_sphere(300, 1.5, {0.3, -0.2, 0.1}), {}, {}};
  const RefinementSummary summary =
      refine({3.0, {{{0, 0, 0}, 1.0}}}, points, options(), [](double, std::string_view) { return false; });
  EXPECT_TRUE(summary.interrupted);
  EXPECT_EQ(summary.model.spheres.size(), 1u);
}

// Writes J and r as dense matrices, with one row for each residual.
void dense(const ResidualBlocks& residuals, Eigen::Index spheres, Eigen::MatrixXd& j, Eigen::VectorXd& r) {
  Eigen::Index rows = 0;
  for (const ResidualBlock& block : residuals.blocks())
    rows += static_cast<Eigen::Index>(block.points.size());
  j = Eigen::MatrixXd::Zero(rows, 4 * spheres + 1);
  r.resize(rows);
  Eigen::Index row = 0;
  for (const ResidualBlock& block : residuals.blocks()) {
    const std::size_t n = block.neighbours.size();
    for (std::size_t p = 0; p < block.points.size(); ++p, ++row) {
      r[row] = block.residuals[p];
      j(row, 4 * spheres) = block.by_sharpness[p];
      for (std::size_t k = 0; k < n; ++k) {
        for (std::size_t a = 0; a < 4; ++a) {
          j(row, 4 * Eigen::Index{block.neighbours[k]} + static_cast<Eigen::Index>(a)) =
              block.by_sphere[p * n + k][a];
        }
      }
    }
  }
}

TEST(NormalEquations, AgreeWithDenseLeastSquares) {
  CounterRandom random(5);
  MetaballModel model{4.0, {}};
  for (int i = 0; i < 12; ++i) {
    const double x = random.uniform(-1, 1), y = random.uniform(-1, 1), z = random.uniform(-1, 1);
    model.spheres.push_back({{x, y, z}, random.uniform(0.2, 0.5)});
  }
  FitPoints points;
  points.on_surface = testing::icosphere(3).vertices;
  RefinementOptions options;
  options.loss_scale = 0.05;
  const RefinementParameters parameters(model);
  ResidualBlocks residuals(points, options, parameters);
  residuals.evaluate();
  NormalEquations equations(residuals, model.spheres.size());
  equations.assemble();
  Eigen::VectorXd step;
  const double damping = 0.1;
  ASSERT_TRUE(equations.solve(damping, step));

  Eigen::MatrixXd j;
  Eigen::VectorXd r;
  dense(residuals, static_cast<Eigen::Index>(model.spheres.size()), j, r);
  EXPECT_NEAR(residuals.cost(), 0.5 * r.squaredNorm(), 1e-12 * r.squaredNorm());
  const Eigen::MatrixXd h = j.transpose() * j;
  const Eigen::VectorXd d = h.diagonal().cwiseMax(1e-8 * h.diagonal().maxCoeff());
  const Eigen::MatrixXd damped = h + damping * Eigen::MatrixXd(d.asDiagonal());
  const Eigen::VectorXd expected = damped.ldlt().solve(-j.transpose() * r);
  EXPECT_LT((step - expected).norm(), 1e-8 * expected.norm());
  const double decrease = 0.5 * r.squaredNorm() - 0.5 * (r + j * step).squaredNorm();
  EXPECT_NEAR(equations.predicted_decrease(step), decrease, 1e-9 * decrease);
}

CenterCondition center_condition(const SurfaceTree& target, const ModelSphere& sphere) {
  RefinementOptions options;
  options.keep_centers_inside = &target;
  const RefinementParameters parameters({4.0, {sphere}});
  ResidualBlocks residuals({testing::icosphere(1).vertices, {}, {}}, options, parameters);
  residuals.evaluate();
  return residuals.center_conditions().front();
}

// By central differences, for a centre inside the target and one outside.
TEST(CenterConditions, DerivativesAreThoseOfTheResidual) {
  const SurfaceTree target(testing::icosphere(3));
  for (const double x : {0.93, 1.1}) {
    const ModelSphere sphere{{x, 0.2, 0.1}, 1.4};
    const CenterCondition condition = center_condition(target, sphere);
    ASSERT_GT(condition.residual, 0.0);
    for (std::size_t k = 0; k < 4; ++k) {
      std::array<double, 2> residuals{};
      for (const double step : {-1e-5, 1e-5}) {
        ModelSphere moved = sphere;
        const std::array<double*, 3> center{&moved.center.x, &moved.center.y, &moved.center.z};
        k < 3 ? *center[k] += step : moved.radius *= std::exp(step);
        residuals[step > 0.0 ? 1 : 0] = center_condition(target, moved).residual;
      }
      EXPECT_NEAR((residuals[1] - residuals[0]) / 2e-5, condition.derivatives[k], 1e-6);
    }
  }
}

}  // namespace
}  // namespace astrolith
