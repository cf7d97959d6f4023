#include "estimation/gabor/image/detrend.h"

#include <Eigen/Core>
#include <algorithm>

#include "numerics/errors.h"

namespace astrolith {
namespace {

using RowMajor = Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor>;

// The Gram polynomials P_0 .. P_degree at n evenly spaced pixels, one per column. Gram-Schmidt on x P_(i-1)
// runs twice to remove rounding errors.
Eigen::MatrixXd gram_polynomials(Eigen::Index n, int degree) {
  const Eigen::VectorXd x = Eigen::VectorXd::LinSpaced(n, -1.0, 1.0);
  Eigen::MatrixXd p(n, degree + 1);
  p.col(0).setConstant(1.0).normalize();
  for (int i = 1; i <= degree; ++i) {
    Eigen::VectorXd next = x.cwiseProduct(p.col(i - 1));
    for (int pass = 0; pass < 2; ++pass) next -= p.leftCols(i) * (p.leftCols(i).transpose() * next);
    p.col(i) = next.normalized();
  }
  return p;
}

}  // namespace

void remove_trend(GreyImage& image, int degree, TrendModel model, const std::string& name) {
  Eigen::Map<RowMajor> v(image.values.data(), image.height, image.width);
  const Eigen::MatrixXd px = gram_polynomials(image.width, degree);
  const Eigen::MatrixXd py = gram_polynomials(image.height, degree);
  Eigen::MatrixXd c = py.transpose() * v * px;
  for (int j = 0; j <= degree; ++j) c.row(j).tail(j).setZero();  // terms with i + j above the degree
  const double mean = v.mean();
  // The trend is computed row by row: for the whole image it would take as much memory as the image.
  for (Eigen::Index y = 0; y < v.rows(); ++y) {
    const Eigen::RowVectorXd t = (py.row(y) * c) * px.transpose();
    if (model == TrendModel::kAdded) {
      v.row(y) += Eigen::RowVectorXd::Constant(v.cols(), mean) - t;
    } else if (t.minCoeff() < 0.1 * mean || mean <= 0.0) {
      throw InputError(name +
                       ": trend removal by division: the trend comes near zero; use a lower degree, or "
                       "subtraction");
    } else {
      v.row(y) = v.row(y).cwiseQuotient(t) * mean;
    }
  }
}

}  // namespace astrolith
