#include <algorithm>

#include "estimation/shape/refinement/normal_equations_internal.h"
#include "numerics/host_device.h"
#include "numerics/parallel_for.h"

namespace astrolith {
namespace {

// Part of the largest diagonal entry that every entry has at least in D: idle spheres must not move freely.
constexpr double kSmallestDamping = 1e-8;

// out[a][c] += sum_r left[r][a] row[r][c] for the first four columns of `rows` as left: the products of one
// sphere's derivatives with those of all that follow it in the block.
ASTROLITH_SIMD_CLONES void add_products(const double* rows, std::size_t row_count, std::size_t row_stride,
                                        std::size_t columns, double* __restrict out) {
  for (std::size_t r = 0; r < row_count; ++r) {
    const double* __restrict row = rows + r * row_stride;
    for (std::size_t a = 0; a < 4; ++a) {
      const double left = row[a];
      double* __restrict sums = out + a * columns;
#pragma omp simd
      for (std::size_t c = 0; c < columns; ++c) sums[c] += left * row[c];
    }
  }
}

}  // namespace

NormalEquations::NormalEquations(const ResidualBlocks& residuals, std::size_t spheres)
    : residuals_(residuals), spheres_(spheres), places_(spheres), partners_(spheres) {
  for (std::size_t b = 0; b < residuals.blocks().size(); ++b) {
    const std::vector<std::int32_t>& neighbours = residuals.blocks()[b].neighbours;
    for (std::size_t k = 0; k < neighbours.size(); ++k) {
      places_[static_cast<std::size_t>(neighbours[k])].push_back(
          {static_cast<std::int32_t>(b), static_cast<std::int32_t>(k)});
    }
  }
  find_pattern();
}

void NormalEquations::find_pattern() {
  parallel_for(0, static_cast<std::int64_t>(spheres_), [&](std::int64_t i) {
    std::vector<char> meets(spheres_, 0);
    meets[static_cast<std::size_t>(i)] = 1;
    for (const Place& place : places_[static_cast<std::size_t>(i)]) {
      for (const std::int32_t j : residuals_.blocks()[static_cast<std::size_t>(place.block)].neighbours) {
        meets[static_cast<std::size_t>(j)] = 1;
      }
    }
    for (auto j = static_cast<std::size_t>(i); j < spheres_; ++j) {
      if (meets[j] != 0) partners_[static_cast<std::size_t>(i)].push_back(static_cast<std::int32_t>(j));
    }
  });
  const auto size = static_cast<Eigen::Index>(4 * spheres_ + 1);
  hessian_.resize(size, size);
  gradient_.resize(size);
  diagonal_.resize(size);
  Eigen::VectorXi entries(size);
  for (std::size_t i = 0; i < spheres_; ++i) {
    entries.segment<4>(static_cast<Eigen::Index>(4 * i))
        .setConstant(static_cast<int>(4 * partners_[i].size() + 1));
  }
  entries[size - 1] = 1;
  hessian_.reserve(entries);
  for (std::size_t i = 0; i < spheres_; ++i) {
    for (int a = 0; a < 4; ++a) {
      const auto column = static_cast<Eigen::Index>(4 * i) + a;
      for (const std::int32_t j : partners_[i]) {
        for (int b = 0; b < 4; ++b) hessian_.insert(4 * Eigen::Index{j} + b, column) = 1.0;
      }
      hessian_.insert(size - 1, column) = 1.0;
    }
  }
  hessian_.insert(size - 1, size - 1) = 1.0;
  hessian_.makeCompressed();
  factor_.analyzePattern(hessian_);
}

void NormalEquations::assemble() {
  parallel_for(0, static_cast<std::int64_t>(spheres_),
               [&](std::int64_t i) { assemble_row(static_cast<std::size_t>(i)); });
  const auto last = static_cast<Eigen::Index>(4 * spheres_);
  double square = 0.0, gradient = 0.0;
  for (const ResidualBlock& block : residuals_.blocks()) {
    for (std::size_t r = 0; r < block.residuals.size(); ++r) {
      square += block.by_sharpness[r] * block.by_sharpness[r];
      gradient += block.by_sharpness[r] * block.residuals[r];
    }
  }
  hessian_.valuePtr()[hessian_.nonZeros() - 1] = square;
  gradient_[last] = gradient;
  diagonal_[last] = square;
  diagonal_ = diagonal_.cwiseMax(kSmallestDamping * diagonal_.maxCoeff());
}

// Row i of blocks: products with all partners, with the sharpness in the last column, and g_i in the one
// after.
void NormalEquations::assemble_row(std::size_t sphere) {
  const std::vector<std::int32_t>& partners = partners_[sphere];
  const auto width = static_cast<Eigen::Index>(4 * partners.size());
  Eigen::MatrixXd row = Eigen::MatrixXd::Zero(4, width + 2);
  std::vector<std::int32_t> slot(spheres_);
  for (std::size_t k = 0; k < partners.size(); ++k) {
    slot[static_cast<std::size_t>(partners[k])] = static_cast<std::int32_t>(k);
  }
  std::vector<double> products;
  for (const Place& place : places_[sphere]) {
    const ResidualBlock& block = residuals_.blocks()[static_cast<std::size_t>(place.block)];
    const std::size_t count = block.neighbours.size(), at = static_cast<std::size_t>(place.position);
    const std::size_t columns = 4 * (count - at), points = block.residuals.size();
    const double* rows = block.by_sphere[at].data();
    products.assign(4 * columns, 0.0);
    add_products(rows, points, 4 * count, columns, products.data());
    for (std::size_t k = at; k < count; ++k) {
      const Eigen::Index to = 4 * Eigen::Index{slot[static_cast<std::size_t>(block.neighbours[k])]};
      for (Eigen::Index a = 0; a < 4; ++a) {
        const double* from = products.data() + static_cast<std::size_t>(a) * columns + 4 * (k - at);
        for (Eigen::Index b = 0; b < 4; ++b) row(a, to + b) += from[b];
      }
    }
    for (std::size_t r = 0; r < points; ++r) {
      for (Eigen::Index a = 0; a < 4; ++a) {
        const double derivative = rows[r * 4 * count + static_cast<std::size_t>(a)];
        row(a, width) += derivative * block.by_sharpness[r];
        row(a, width + 1) += derivative * block.residuals[r];
      }
    }
  }
  add_center_condition(sphere, row);
  store_row(sphere, row);
}

void NormalEquations::add_center_condition(std::size_t sphere, Eigen::Ref<Eigen::MatrixXd> row) {
  if (residuals_.center_conditions().empty()) return;
  const CenterCondition& condition = residuals_.center_conditions()[sphere];
  for (Eigen::Index a = 0; a < 4; ++a) {
    const double left = condition.derivatives[static_cast<std::size_t>(a)];
    for (Eigen::Index b = 0; b < 4; ++b)
      row(a, b) += left * condition.derivatives[static_cast<std::size_t>(b)];
    row(a, row.cols() - 1) += left * condition.residual;
  }
}

void NormalEquations::store_row(std::size_t sphere, const Eigen::MatrixXd& row) {
  const Eigen::Index entries = row.cols() - 1;
  for (Eigen::Index a = 0; a < 4; ++a) {
    const auto column = static_cast<Eigen::Index>(4 * sphere) + a;
    double* values = hessian_.valuePtr() + hessian_.outerIndexPtr()[column];
    for (Eigen::Index k = 0; k < entries; ++k) values[k] = row(a, k);
    gradient_[column] = row(a, entries);
    diagonal_[column] = row(a, a);
  }
}

bool NormalEquations::solve(double damping, Eigen::VectorXd& step) {
  Eigen::SparseMatrix<double> damped = hessian_;
  for (Eigen::Index column = 0; column < damped.cols(); ++column) {
    // Within the diagonal block, or the last entry of all.
    const Eigen::Index within = column + 1 < damped.cols() ? column % 4 : 0;
    damped.valuePtr()[damped.outerIndexPtr()[column] + within] += damping * diagonal_[column];
  }
  factor_.factorize(damped);
  if (factor_.info() != Eigen::Success) return false;
  step = factor_.solve(-gradient_);
  return factor_.info() == Eigen::Success && step.allFinite();
}

double NormalEquations::predicted_decrease(const Eigen::VectorXd& step) const {
  return -gradient_.dot(step) - 0.5 * step.dot(hessian_.selfadjointView<Eigen::Lower>() * step);
}

}  // namespace astrolith
