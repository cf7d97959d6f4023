// The normal equations of one step of the refinement: H = J^T J and g = J^T r over all residual blocks, with
// H a sparse matrix of 4 x 4 blocks (one row of them a sphere) and one row more for the sharpness.
//
// Every row is summed by one thread in the order of the blocks, so that the sums are the same for every
// number of threads.
#pragma once

#include <Eigen/CholmodSupport>
#include <cstdint>
#include <vector>

#include "estimation/shape/refinement/residual_blocks_internal.h"

namespace astrolith {

class NormalEquations {
 public:
  // Finds which spheres meet in a block. `residuals` must outlive this.
  NormalEquations(const ResidualBlocks& residuals, std::size_t spheres);

  // Sums the blocks as they were last evaluated, with derivatives.
  void assemble();

  // (H + damping D) step = -g with D the diagonal of H; false when that is not positive definite.
  bool solve(double damping, Eigen::VectorXd& step);

  // By how much the linear model lowers the cost with this step.
  double predicted_decrease(const Eigen::VectorXd& step) const;

 private:
  struct Place {
    std::int32_t block;
    std::int32_t position;  // in the block's list of neighbours
  };

  void find_pattern();
  void assemble_row(std::size_t sphere);
  void add_center_condition(std::size_t sphere, Eigen::Ref<Eigen::MatrixXd> row);
  void store_row(std::size_t sphere, const Eigen::MatrixXd& row);

  const ResidualBlocks& residuals_;
  std::size_t spheres_;
  std::vector<std::vector<Place>> places_;  // of every sphere, in the order of blocks
  std::vector<std::vector<std::int32_t>>
      partners_;                         // spheres j >= i that meet sphere i in a block, ascending
  Eigen::SparseMatrix<double> hessian_;  // lower triangle; whole blocks on the diagonal
  Eigen::VectorXd gradient_, diagonal_;
  Eigen::CholmodDecomposition<Eigen::SparseMatrix<double>, Eigen::Lower> factor_;
};

}  // namespace astrolith
