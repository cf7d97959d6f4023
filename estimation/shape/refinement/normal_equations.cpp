#include <algorithm>
#include <iterator>

#include "estimation/shape/refinement/normal_equations_internal.h"
#include "numerics/host_device.h"
#include "numerics/parallel_for.h"

// These two functions are libgomp's, which CHOLMOD brings along. They are declared here since clang's <omp.h>
// is that of another library.
extern "C" void omp_set_max_active_levels(int levels);
extern "C" int omp_get_max_active_levels();

namespace astrolith {
namespace {

// CHOLMOD starts four threads for each of its many small loops, on any machine. Here its loops run on the
// calling thread, which takes a sixth less of the processor's time and a quarter less on the clock.
class OpenMpThreadsOff {
 public:
  OpenMpThreadsOff() { omp_set_max_active_levels(0); }
  OpenMpThreadsOff(const OpenMpThreadsOff&) = delete;
  OpenMpThreadsOff& operator=(const OpenMpThreadsOff&) = delete;
  ~OpenMpThreadsOff() { omp_set_max_active_levels(before_); }

 private:
  int before_ = omp_get_max_active_levels();
};

// Every entry of D is at least this part of the largest, so that idle spheres do not move freely.
constexpr double kLeastDiagonal = 1e-8;

// out[a][c] = sum_r rows[r][a] rows[r][first + c] for a = 0 .. 3 and some columns c. The sums stay in
// registers.
template <std::size_t columns>
ASTROLITH_KERNEL void column_products(const double* rows, std::size_t row_count, std::size_t row_stride,
                                      std::size_t first, double* __restrict out, std::size_t out_stride) {
  double sums[4][columns] = {};
  for (std::size_t r = 0; r < row_count; ++r) {
    const double* row = rows + r * row_stride;
    ASTROLITH_UNROLL
    for (std::size_t a = 0; a < 4; ++a) {
      const double left = row[a];
#pragma omp simd
      for (std::size_t c = 0; c < columns; ++c) sums[a][c] += left * row[first + c];
    }
  }
  ASTROLITH_UNROLL
  for (std::size_t a = 0; a < 4; ++a) {
#pragma omp simd
    for (std::size_t c = 0; c < columns; ++c) out[a * out_stride + c] = sums[a][c];
  }
}

// out[a][c] = sum_r rows[r][a] rows[r][c] for a = 0 .. 3 and all columns c, a multiple of 4. The first four
// columns of `rows` are the derivatives by one sphere, and the other columns those by the spheres that follow
// it in the block.
ASTROLITH_SIMD_CLONES void sphere_products(const double* rows, std::size_t row_count, std::size_t row_stride,
                                           std::size_t columns, double* __restrict out) {
  std::size_t c = 0;
  for (; c + 8 <= columns; c += 8) column_products<8>(rows, row_count, row_stride, c, out + c, columns);
  if (c < columns) column_products<4>(rows, row_count, row_stride, c, out + c, columns);
}

}  // namespace

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
    std::vector<std::int32_t>& partners = partners_[static_cast<std::size_t>(i)];
    std::vector<std::int32_t> merged;
    partners = {static_cast<std::int32_t>(i)};
    for (const Place& place : places_[static_cast<std::size_t>(i)]) {
      const auto& neighbours = residuals_.blocks()[static_cast<std::size_t>(place.block)].neighbours;
      merged.clear();
      std::set_union(partners.begin(), partners.end(), neighbours.begin() + place.position, neighbours.end(),
                     std::back_inserter(merged));
      partners.swap(merged);
    }
  });
}

// Every column of a sphere holds its partners' rows and the row of the sharpness, which is the last.
void NormalEquations::make_pattern() {
  const auto size = static_cast<Eigen::Index>(4 * spheres_ + 1);
  hessian_.resize(size, size);
  gradient_.resize(size);
  diagonal_.resize(size);
  int entries = 0;
  for (std::size_t i = 0; i < spheres_; ++i) {
    for (std::size_t a = 0; a < 4; ++a) {
      hessian_.outerIndexPtr()[4 * i + a] = entries;
      entries += static_cast<int>(4 * partners_[i].size() + 1);
    }
  }
  hessian_.outerIndexPtr()[4 * spheres_] = entries;
  hessian_.outerIndexPtr()[4 * spheres_ + 1] = entries + 1;
  hessian_.resizeNonZeros(entries + 1);
  int* row = hessian_.innerIndexPtr();
  for (std::size_t i = 0; i < spheres_; ++i) {
    for (int a = 0; a < 4; ++a) {
      for (const std::int32_t j : partners_[i]) {
        for (int b = 0; b < 4; ++b) *row++ = 4 * j + b;
      }
      *row++ = static_cast<int>(size) - 1;
    }
  }
  *row = static_cast<int>(size) - 1;
  std::fill_n(hessian_.valuePtr(), hessian_.nonZeros(), 1.0);
  factor_.analyzePattern(hessian_);
}

void NormalEquations::assemble() {
  parallel_for(0, static_cast<std::int64_t>(spheres_),
               [&](std::int64_t i) { assemble_row(static_cast<std::size_t>(i)); });
  assemble_sharpness();
  diagonal_ = diagonal_.cwiseMax(kLeastDiagonal * diagonal_.maxCoeff());
}

// Sums the rows of H and g that belong to one sphere. H is symmetric, so only the products with the sphere
// itself and with later spheres are needed. Row a of the sphere's products is column 4 i + a of the lower
// triangle.
void NormalEquations::assemble_row(std::size_t sphere) {
  const std::vector<std::int32_t>& partners = partners_[sphere];
  const std::size_t stride = 4 * partners.size() + 1;
  double* columns = hessian_.valuePtr() + hessian_.outerIndexPtr()[4 * sphere];
  std::fill_n(columns, 4 * stride, 0.0);
  Eigen::Vector4d by_sharpness = Eigen::Vector4d::Zero(), gradient = Eigen::Vector4d::Zero();
  std::vector<double> products;
  for (const Place& place : places_[sphere]) {
    const ResidualBlock& block = residuals_.blocks()[static_cast<std::size_t>(place.block)];
    const auto position = static_cast<std::size_t>(place.position);
    add_products(block, position, partners, products, columns);
    const std::size_t neighbours = block.neighbours.size();
    for (std::size_t r = 0; r < block.residuals.size(); ++r) {
      const Eigen::Map<const Eigen::Vector4d> derivatives(block.by_sphere[r * neighbours + position].data());
      by_sharpness += derivatives * block.by_sharpness[r];
      gradient += derivatives * block.residuals[r];
    }
  }
  if (!residuals_.center_conditions().empty()) {
    const CenterCondition& condition = residuals_.center_conditions()[sphere];
    const Eigen::Map<const Eigen::Vector4d> derivatives(condition.derivatives.data());
    for (std::size_t a = 0; a < 4; ++a) {
      for (std::size_t b = 0; b < 4; ++b) {
        columns[a * stride + b] += condition.derivatives[a] * condition.derivatives[b];
      }
    }
    gradient += derivatives * condition.residual;
  }
  for (std::size_t a = 0; a < 4; ++a) {
    const auto column = static_cast<Eigen::Index>(4 * sphere + a);
    columns[(a + 1) * stride - 1] = by_sharpness[static_cast<Eigen::Index>(a)];
    gradient_[column] = gradient[static_cast<Eigen::Index>(a)];
    diagonal_[column] = columns[a * stride + a];
  }
}

// Adds the products of one block to a sphere's columns. The block's spheres are among the partners, in the
// same order.
void NormalEquations::add_products(const ResidualBlock& block, std::size_t position,
                                   const std::vector<std::int32_t>& partners, std::vector<double>& products,
                                   double* columns) {
  const std::size_t neighbours = block.neighbours.size(), stride = 4 * partners.size() + 1;
  const std::size_t product_stride = 4 * (neighbours - position);
  products.resize(4 * product_stride);
  sphere_products(block.by_sphere[position].data(), block.points.size(), 4 * neighbours, product_stride,
                  products.data());
  std::size_t partner = 0;
  for (std::size_t k = position; k < neighbours; ++k) {
    while (partners[partner] != block.neighbours[k]) ++partner;
    for (std::size_t a = 0; a < 4; ++a) {
      const double* from = products.data() + a * product_stride + 4 * (k - position);
      double* to = columns + a * stride + 4 * partner;
      for (std::size_t b = 0; b < 4; ++b) to[b] += from[b];
    }
  }
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

const Eigen::SparseMatrix<double>& NormalEquations::damped(double damping) {
  if (damped_.nonZeros() != hessian_.nonZeros()) damped_ = hessian_;
  std::copy_n(hessian_.valuePtr(), hessian_.nonZeros(), damped_.valuePtr());
  for (Eigen::Index column = 0; column < damped_.cols(); ++column) {
    // The diagonal's place among the entries of its column: the block on the diagonal comes first.
    const Eigen::Index within = column + 1 < damped_.cols() ? column % 4 : 0;
    damped_.valuePtr()[damped_.outerIndexPtr()[column] + within] += damping * diagonal_[column];
  }
  return damped_;
}

bool NormalEquations::solve(double damping, Eigen::VectorXd& step) {
  const OpenMpThreadsOff alone;
  factor_.factorize(damped(damping));
  if (factor_.info() != Eigen::Success) return false;
  step = factor_.solve(-gradient_);
  return factor_.info() == Eigen::Success && step.allFinite();
}

double NormalEquations::predicted_decrease(const Eigen::VectorXd& step) const {
  return -gradient_.dot(step) - 0.5 * step.dot(hessian_.selfadjointView<Eigen::Lower>() * step);
}

}  // namespace astrolith
