#include "estimation/gabor/image/image_channels.h"

#include <Eigen/Eigenvalues>
#include <cmath>

#include "numerics/sample_statistics.h"

namespace astrolith {
namespace {

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

Vec3d mean_color(const std::vector<GreyImage>& planes) {
  return {mean_of(planes[0].values), mean_of(planes[1].values), mean_of(planes[2].values)};
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
