#include <gtest/gtest.h>

#include <Eigen/Dense>
#include <array>
#include <cmath>

#include "estimation/shape/refinement/normal_equations_internal.h"
#include "numerics/hash_random.h"
#include "tests/support/meshes.h"

namespace astrolith {
namespace {

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
