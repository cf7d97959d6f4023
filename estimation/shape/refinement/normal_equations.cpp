#include <algorithm>

#include "estimation/shape/refinement/normal_equations_internal.h"
#include "numerics/host_device.h"
#include "numerics/parallel_for.h"

namespace astrolith {
namespace {

// Every entry of D is at least this part of the largest, so that idle spheres do not move freely.
constexpr double kLeastDiagonal = 1e-8;

// out[a][c] += sum_r rows[r][a] rows[r][c] for a = 0 .. 3 and all columns c. The first four columns of `rows`
// are the derivatives by one sphere, and the other columns those by the spheres that follow it in the block.
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

// The rows of H and g that belong to one sphere, while they are summed. H is symmetric, so only the products
// with the sphere itself and with later spheres are needed.
class NormalEquations::SphereRow {
 public:
  // `partners` are the spheres of the row's blocks, ascending; the first is the sphere itself.
  SphereRow(const std::vector<std::int32_t>& partners, std::size_t spheres)
      : by_partners_(Eigen::MatrixXd::Zero(4, static_cast<Eigen::Index>(4 * partners.size()))),
        column_of_sphere_(spheres) {
    for (std::size_t k = 0; k < partners.size(); ++k) {
      column_of_sphere_[static_cast<std::size_t>(partners[k])] = static_cast<Eigen::Index>(4 * k);
    }
  }

  // Adds the products of a residual block, in which the sphere stands at `position` in the list of
  // neighbours.
  void add(const ResidualBlock& block, std::size_t position) {
    add_products_with_spheres(block, position);
    const std::size_t neighbours = block.neighbours.size();
    for (std::size_t r = 0; r < block.residuals.size(); ++r) {
      const Eigen::Map<const Eigen::Vector4d> derivatives(block.by_sphere[r * neighbours + position].data());
      by_sharpness_ += derivatives * block.by_sharpness[r];
      gradient_ += derivatives * block.residuals[r];
    }
  }

  // Adds the products of the condition on the sphere's centre.
  void add(const CenterCondition& condition) {
    const Eigen::Map<const Eigen::Vector4d> derivatives(condition.derivatives.data());
    by_partners_.leftCols<4>() += derivatives * derivatives.transpose();
    gradient_ += derivatives * condition.residual;
  }

  const Eigen::MatrixXd& by_partners() const { return by_partners_; }  // (4 x 4 #partners)
  const Eigen::Vector4d& by_sharpness() const { return by_sharpness_; }
  const Eigen::Vector4d& gradient() const { return gradient_; }

 private:
  void add_products_with_spheres(const ResidualBlock& block, std::size_t position) {
    const std::size_t neighbours = block.neighbours.size(), columns = 4 * (neighbours - position);
    products_.setZero(4, static_cast<Eigen::Index>(columns));
    add_products(block.by_sphere[position].data(), block.residuals.size(), 4 * neighbours, columns,
                 products_.data());
    Eigen::Index from = 0;
    for (std::size_t k = position; k < neighbours; ++k, from += 4) {
      const Eigen::Index to = column_of_sphere_[static_cast<std::size_t>(block.neighbours[k])];
      by_partners_.middleCols<4>(to) += products_.middleCols<4>(from);
    }
  }

  Eigen::MatrixXd by_partners_;
  Eigen::Vector4d by_sharpness_ = Eigen::Vector4d::Zero();
  Eigen::Vector4d gradient_ = Eigen::Vector4d::Zero();
  std::vector<Eigen::Index> column_of_sphere_;                          // where a partner's products begin
  Eigen::Matrix<double, 4, Eigen::Dynamic, Eigen::RowMajor> products_;  // scratch, of one block
};

NormalEquations::NormalEquations(const ResidualBlocks& residuals, std::size_t spheres)
    : residuals_(residuals), spheres_(spheres), places_(spheres), partners_(spheres) {
  find_places();
  find_partners();
  make_pattern();
}

void NormalEquations::find_places() {
  for (std::size_t b = 0; b < residuals_.blocks().size(); ++b) {
    const std::vector<std::int32_t>& neighbours = residuals_.blocks()[b].neighbours;
    for (std::size_t k = 0; k < neighbours.size(); ++k) {
      places_[static_cast<std::size_t>(neighbours[k])].push_back(
          {static_cast<std::int32_t>(b), static_cast<std::int32_t>(k)});
    }
  }
}

void NormalEquations::find_partners() {
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
}

// Every column of a sphere holds its partners' rows and the row of the sharpness, which is the last.
void NormalEquations::make_pattern() {
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
  assemble_sharpness();
  diagonal_ = diagonal_.cwiseMax(kLeastDiagonal * diagonal_.maxCoeff());
}

void NormalEquations::assemble_row(std::size_t sphere) {
  SphereRow row(partners_[sphere], spheres_);
  for (const Place& place : places_[sphere]) {
    row.add(residuals_.blocks()[static_cast<std::size_t>(place.block)],
            static_cast<std::size_t>(place.position));
  }
  if (!residuals_.center_conditions().empty()) row.add(residuals_.center_conditions()[sphere]);
  store(sphere, row);
}

void NormalEquations::assemble_sharpness() {
  double square = 0.0, gradient = 0.0;
  for (const ResidualBlock& block : residuals_.blocks()) {
    for (std::size_t r = 0; r < block.residuals.size(); ++r) {
      square += block.by_sharpness[r] * block.by_sharpness[r];
      gradient += block.by_sharpness[r] * block.residuals[r];
    }
  }
  const auto last = static_cast<Eigen::Index>(4 * spheres_);
  hessian_.valuePtr()[hessian_.nonZeros() - 1] = square;
  gradient_[last] = gradient;
  diagonal_[last] = square;
}

void NormalEquations::store(std::size_t sphere, const SphereRow& row) {
  const Eigen::Index entries = row.by_partners().cols();
  for (Eigen::Index a = 0; a < 4; ++a) {
    const auto column = static_cast<Eigen::Index>(4 * sphere) + a;
    double* values = hessian_.valuePtr() + hessian_.outerIndexPtr()[column];
    for (Eigen::Index k = 0; k < entries; ++k) values[k] = row.by_partners()(a, k);
    values[entries] = row.by_sharpness()[a];
    gradient_[column] = row.gradient()[a];
    diagonal_[column] = row.by_partners()(a, a);
  }
}

Eigen::SparseMatrix<double> NormalEquations::damped(double damping) const {
  Eigen::SparseMatrix<double> damped = hessian_;
  for (Eigen::Index column = 0; column < damped.cols(); ++column) {
    // The diagonal's place among the entries of its column: the block on the diagonal comes first.
    const Eigen::Index within = column + 1 < damped.cols() ? column % 4 : 0;
    damped.valuePtr()[damped.outerIndexPtr()[column] + within] += damping * diagonal_[column];
  }
  return damped;
}

bool NormalEquations::solve(double damping, Eigen::VectorXd& step) {
  factor_.factorize(damped(damping));
  if (factor_.info() != Eigen::Success) return false;
  step = factor_.solve(-gradient_);
  return factor_.info() == Eigen::Success && step.allFinite();
}

double NormalEquations::predicted_decrease(const Eigen::VectorXd& step) const {
  return -gradient_.dot(step) - 0.5 * step.dot(hessian_.selfadjointView<Eigen::Lower>() * step);
}

}  // namespace astrolith
