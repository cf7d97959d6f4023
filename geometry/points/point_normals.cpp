#include "geometry/points/point_normals.h"

#include <Eigen/Eigenvalues>
#include <cstdint>
#include <string>

#include "geometry/points/nearest_neighbours.h"
#include "numerics/errors.h"
#include "numerics/parallel_for.h"

namespace astrolith {
namespace {

// The direction in which point i and the points around it are spread least about their mean.
Vec3d plane_normal(std::span<const Vec3d> points, std::uint32_t i, std::span<const std::uint32_t> around) {
  Vec3d mean{};  // relative to point i: small differences of large coordinates keep their digits
  for (const std::uint32_t j : around) mean += points[j] - points[i];
  mean *= 1.0 / static_cast<double>(around.size() + 1);
  Eigen::Matrix3d spread = Eigen::Matrix3d::Zero();
  const auto add = [&](const Vec3d& p) {
    const Eigen::Vector3d d(p.x - mean.x, p.y - mean.y, p.z - mean.z);
    spread += d * d.transpose();
  };
  add({});
  for (const std::uint32_t j : around) add(points[j] - points[i]);
  const Eigen::Vector3d n = Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d>(spread).eigenvectors().col(0);
  return {n.x(), n.y(), n.z()};
}

}  // namespace

std::vector<Vec3d> point_normals(std::span<const Vec3d> points, std::span<const Vec3d> hints, int k) {
  if (points.size() != hints.size() || k < 2) {
    throw InputError("point normals: " + std::to_string(points.size()) + " points have " +
                     std::to_string(hints.size()) + " hints and " + std::to_string(k) +
                     " neighbours; give a hint for each and at least 2 neighbours");
  }
  const std::vector<std::uint32_t> neighbours = nearest_neighbours(points, k);
  std::vector<Vec3d> normals(points.size());
  parallel_for(
      0, static_cast<std::int64_t>(points.size()),
      [&](std::int64_t index) {
        const auto i = static_cast<std::uint32_t>(index);
        const auto row =
            std::span(neighbours).subspan(i * static_cast<std::size_t>(k), static_cast<std::size_t>(k));
        const Vec3d n = plane_normal(points, i, row);
        normals[i] = dot(n, hints[i]) < 0 ? -n : n;
      },
      64);
  return normals;
}

}  // namespace astrolith
