#include "estimation/gabor/image/image_channels.h"

#include <Eigen/Core>
#include <Eigen/Eigenvalues>
#include <algorithm>
#include <cmath>

#include "numerics/errors.h"
#include "numerics/sample_statistics.h"

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

Eigen::Vector3d pixel(const std::vector<GreyImage>& planes, std::size_t i) {
  return {planes[0].values[i], planes[1].values[i], planes[2].values[i]};
}

Eigen::Matrix3d covariance(const std::vector<GreyImage>& planes) {
  const Vec3d mean = mean_color(planes);
  const Eigen::Vector3d center(mean.x, mean.y, mean.z);
  Eigen::Matrix3d sum = Eigen::Matrix3d::Zero();
  const std::size_t n = planes[0].values.size();
  for (std::size_t i = 0; i < n; ++i) {
    const Eigen::Vector3d d = pixel(planes, i) - center;
    sum += d * d.transpose();
  }
  return sum / static_cast<double>(n);
}

// Chooses the sign of an eigenvector: it points towards brighter colours. Where its components add up to
// zero, its first component that is not zero becomes positive.
Eigen::Vector3d towards_brighter(Eigen::Vector3d axis) {
  double sign = axis.sum();
  for (int i = 0; std::abs(sign) < 1e-9 && i < 3; ++i) sign = axis(i);
  return sign < 0.0 ? Eigen::Vector3d(-axis) : axis;
}

GreyImage project(const std::vector<GreyImage>& planes, const Eigen::Vector3d& axis) {
  GreyImage image{planes[0].width, planes[0].height, {}};
  image.values.reserve(planes[0].values.size());
  for (std::size_t i = 0; i < planes[0].values.size(); ++i)
    image.values.push_back(axis.dot(pixel(planes, i)));
  return image;
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

Vec3d mean_color(const std::vector<GreyImage>& planes) {
  return {sample_mean(planes[0].values), sample_mean(planes[1].values), sample_mean(planes[2].values)};
}

std::vector<ImageChannel> principal_channels(const std::vector<GreyImage>& planes,
                                             double smallest_deviation) {
  const Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d> solver(covariance(planes));
  std::vector<ImageChannel> channels;
  for (int k = 2; k >= 0; --k) {  // eigenvalues ascend
    const double variance = solver.eigenvalues()(k);
    if (k < 2 && variance < smallest_deviation * smallest_deviation) break;
    const Eigen::Vector3d axis = towards_brighter(solver.eigenvectors().col(k));
    channels.push_back({project(planes, axis), {axis.x(), axis.y(), axis.z()}});
  }
  return channels;
}

}  // namespace astrolith
