#include "estimation/shape/model/point_clusters.h"

#include <algorithm>
#include <array>
#include <numeric>
#include <span>

namespace astrolith {
namespace {

PointCluster cluster_of(const std::vector<Vec3d>& points, std::span<const std::int32_t> indices,
                        const Box& box) {
  PointCluster cluster{{indices.begin(), indices.end()}, box.center(), 0.0};
  for (const std::int32_t i : indices) {
    cluster.radius = std::max(cluster.radius, norm(points[static_cast<std::size_t>(i)] - cluster.center));
  }
  return cluster;
}

int longest_axis(const Vec3d& extent) {
  if (extent.x >= extent.y && extent.x >= extent.z) return 0;
  return extent.y >= extent.z ? 1 : 2;
}

double coordinate(const Vec3d& p, int axis) { return axis == 0 ? p.x : axis == 1 ? p.y : p.z; }

void split(const std::vector<Vec3d>& points, std::span<std::int32_t> indices, std::size_t size,
           std::vector<PointCluster>& clusters) {
  Box box;
  for (const std::int32_t i : indices) box.extend(points[static_cast<std::size_t>(i)]);
  if (indices.size() <= size) {
    clusters.push_back(cluster_of(points, indices, box));
    return;
  }
  const int axis = longest_axis(box.extent());
  const std::size_t half = indices.size() / 2;
  // Points with equal coordinates are ordered by index, so that the order does not depend on the library.
  std::nth_element(indices.begin(), indices.begin() + static_cast<std::ptrdiff_t>(half), indices.end(),
                   [&](std::int32_t i, std::int32_t j) {
                     const double xi = coordinate(points[static_cast<std::size_t>(i)], axis);
                     const double xj = coordinate(points[static_cast<std::size_t>(j)], axis);
                     return xi < xj || (xi == xj && i < j);
                   });
  split(points, indices.first(half), size, clusters);
  split(points, indices.subspan(half), size, clusters);
}

}  // namespace

std::vector<PointCluster> cluster_points(const std::vector<Vec3d>& points, std::size_t size) {
  std::vector<std::int32_t> indices(points.size());
  std::iota(indices.begin(), indices.end(), 0);
  std::vector<PointCluster> clusters;
  if (!points.empty()) split(points, indices, std::max<std::size_t>(size, 1), clusters);
  return clusters;
}

}  // namespace astrolith
