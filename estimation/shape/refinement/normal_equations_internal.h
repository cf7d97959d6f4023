// The normal equations of one step of the refinement: H = J^T J and g = J^T r, summed over all residual
// blocks. H is a sparse matrix of 4 x 4 blocks with one row of blocks for each sphere, and one more row for
// the sharpness.
//
// One thread sums all of a row, in the order of the residual blocks. The sums are therefore the same for
// every number of threads.
#pragma once

#include <Eigen/CholmodSupport>
#include <cstdint>
#include <vector>

#include "estimation/shape/refinement/residual_blocks_internal.h"

namespace astrolith {

class NormalEquations {
 public:
  // Finds which spheres meet in a residual block, and with them the pattern of H. `residuals` must outlive
  // this.
  NormalEquations(const ResidualBlocks& residuals, std::size_t spheres);

  // Sums the blocks as they were last evaluated.
  void assemble();

  // The lower triangle of H + damping D, until the next call.
  const Eigen::SparseMatrix<double>& damped(double damping);

  // Solves (H + damping D) step = -g, where D is the diagonal of H. Returns false where the matrix is not
  // positive definite.
  bool solve(double damping, Eigen::VectorXd& step);

  // How much the linear model lowers the cost with this step.
  double predicted_decrease(const Eigen::VectorXd& step) const;

 private:
  struct Place {
    std::int32_t block;
    std::int32_t position;  // in the block's list of neighbours
  };

  void find_places();
  void find_partners();
  void make_pattern();
  void assemble_row(std::size_t sphere);
  void assemble_sharpness();
  static void add_products(const ResidualBlock& block, std::size_t position,
                           const std::vector<std::int32_t>& partners, std::vector<double>& products,
                           double* columns);

  const ResidualBlocks& residuals_;
  std::size_t spheres_;
  std::vector<std::vector<Place>> places_;  // blocks of every sphere, in the order of blocks
  std::vector<std::vector<std::int32_t>>
      partners_;                         // spheres j >= i that meet sphere i in a block, ascending
  Eigen::SparseMatrix<double> hessian_;  // lower triangle; whole blocks on the diagonal
  Eigen::SparseMatrix<double> damped_;   // with the same pattern
  Eigen::VectorXd gradient_, diagonal_;
  Eigen::CholmodDecomposition<Eigen::SparseMatrix<double>, Eigen::Lower> factor_;
};

}  // namespace astrolith
