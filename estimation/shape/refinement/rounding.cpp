#include "estimation/shape/refinement/rounding.h"

#include <Eigen/SparseCholesky>
#include <algorithm>
#include <cmath>

#include "estimation/shape/refinement/normal_equations_internal.h"
#include "numerics/errors.h"

namespace astrolith {
namespace {

// Making up for errors moves a centre by at most this fraction of its sphere's radius, and a log radius by at
// most this much. Farther away the surface is not linear in them.
constexpr double kFarthest = 0.3;

double nearest_multiple(double x, double step) { return std::round(x / step) * step; }

// The parameters of the model with its own sharpness, however near to the limits of the refinement.
RefinementParameters to_parameters(const MetaballModel& model) {
  constexpr double kNearest = 1.0 - 1e-9;
  RefinementParameters parameters(model);
  const double part = (std::log(model.sharpness) - parameters.middle) / parameters.half;
  parameters.sharpness = parameters.half * std::atanh(std::clamp(part, -kNearest, kNearest));
  return parameters;
}

// Rounds the numbers of RefinementParameters: centres and log radii. The sharpness, the last, stays.
class NumberRounding {
 public:
  NumberRounding(const RefinementParameters& parameters, const FileFrame& frame, double step)
      : parameters_(parameters), frame_(frame), step_(step) {}

  double operator()(std::size_t number, double value) const {
    if (number == 4 * parameters_.spheres.size()) return parameters_.sharpness;
    const std::size_t k = number % 4;
    const SphereDerivatives& sphere = parameters_.spheres[number / 4];
    const double most = k == 3 ? kFarthest : kFarthest * std::exp(sphere[3]);
    value = std::clamp(value, sphere[k] - most, sphere[k] + most);
    return k == 3 ? log_radius(value)
                  : coordinate(value, k == 0   ? frame_.origin.x
                                      : k == 1 ? frame_.origin.y
                                               : frame_.origin.z);
  }

 private:
  double coordinate(double value, double origin) const {
    return (nearest_multiple(origin + frame_.scale * value, step_) - origin) / frame_.scale;
  }
  double log_radius(double value) const {
    const double radius = nearest_multiple(frame_.scale * std::exp(value), step_);
    return std::log(std::max(radius, step_) / frame_.scale);
  }

  const RefinementParameters& parameters_;
  const FileFrame& frame_;
  double step_;
};

}  // namespace

struct ModelRounding::Factor {
  Eigen::SimplicialLLT<Eigen::SparseMatrix<double>, Eigen::Lower> cholesky;
};

ModelRounding::ModelRounding(const MetaballModel& model, const FitPoints& points,
                             const RefinementOptions& options, double damping)
    : model_(model), factor_(std::make_unique<Factor>()) {
  const RefinementParameters parameters = to_parameters(model);
  ResidualBlocks residuals(points, options, parameters);
  residuals.evaluate();
  NormalEquations equations(residuals, model.spheres.size());
  equations.assemble();
  factor_->cholesky.compute(equations.damped(damping));
  if (factor_->cholesky.info() != Eigen::Success)
    throw WorkError("rounding: the normal equations are singular");
}

ModelRounding::~ModelRounding() = default;

MetaballModel ModelRounding::rounded(const FileFrame& frame, double step) const {
  RefinementParameters parameters = to_parameters(model_);
  const NumberRounding round(parameters, frame, step);
  const auto count = static_cast<Eigen::Index>(4 * parameters.spheres.size() + 1);
  Eigen::VectorXd wanted(count);
  for (Eigen::Index i = 0; i + 1 < count; ++i) {
    wanted[i] = parameters.spheres[static_cast<std::size_t>(i / 4)][static_cast<std::size_t>(i % 4)];
  }
  wanted[count - 1] = parameters.sharpness;
  const auto& lower = factor_->cholesky.matrixL().nestedExpression();
  const auto& place = factor_->cholesky.permutationPinv().indices();  // of the number at each row of L
  Eigen::VectorXd error = Eigen::VectorXd::Zero(count), numbers(count);
  for (Eigen::Index row = count - 1; row >= 0; --row) {
    // The column of L below its diagonal holds the numbers that are rounded already.
    double diagonal = 1.0, made_up = 0.0;
    for (Eigen::SparseMatrix<double>::InnerIterator entry(lower, row); entry; ++entry) {
      if (entry.row() == row) diagonal = entry.value();
      if (entry.row() > row) made_up += entry.value() * error[entry.row()];
    }
    const Eigen::Index number = place[row];
    const double value = round(static_cast<std::size_t>(number), wanted[number] - made_up / diagonal);
    error[row] = value - wanted[number];
    numbers[number] = value;
  }
  for (Eigen::Index i = 0; i + 1 < count; ++i) {
    parameters.spheres[static_cast<std::size_t>(i / 4)][static_cast<std::size_t>(i % 4)] = numbers[i];
  }
  MetaballModel result = parameters.model();
  result.sharpness = model_.sharpness;
  return result;
}

}  // namespace astrolith
