#include "estimation/shape/model/model_evaluation_internal.h"

#include <algorithm>
#include <cmath>

#include "numerics/parallel_for.h"

namespace astrolith {
namespace {

// Sides with more points are split in parallel.
constexpr std::size_t kManyPoints = 2048;

// A point that carries its index, so that the split reads memory in order.
struct IndexedPoint {
  Vec3d at;
  std::int32_t index;
};

// As Box::extend(), which calls a function of the C library for each coordinate.
Box bounding_box(std::span<const IndexedPoint> points) {
  Box box;
  for (const auto& [at, index] : points) {
    box.min = {std::min(box.min.x, at.x), std::min(box.min.y, at.y), std::min(box.min.z, at.z)};
    box.max = {std::max(box.max.x, at.x), std::max(box.max.y, at.y), std::max(box.max.z, at.z)};
  }
  return box;
}

PointCluster make_cluster(std::span<const IndexedPoint> points, const Vec3d& center) {
  PointCluster cluster{{}, center, 0.0};
  cluster.points.reserve(points.size());
  for (const IndexedPoint& p : points) {
    cluster.points.push_back(p.index);
    cluster.radius = std::max(cluster.radius, norm(p.at - center));
  }
  return cluster;
}

// Splits the points into all of these clusters.
void split(std::span<IndexedPoint> points, std::span<PointCluster> clusters) {
  const Box box = bounding_box(points);
  if (clusters.size() == 1) {
    clusters.front() = make_cluster(points, box.center());
    return;
  }
  // Each side gets its share of the clusters and of the points, so that clusters are nearly full.
  const std::size_t first = clusters.size() / 2;
  const std::size_t half = (points.size() * first + clusters.size() - 1) / clusters.size();
  // Points with equal coordinates are ordered by index, so that the order does not depend on the library.
  double Vec3d::*const axis = longest_axis(box.extent());
  std::nth_element(points.begin(), points.begin() + static_cast<std::ptrdiff_t>(half), points.end(),
                   [axis](const IndexedPoint& a, const IndexedPoint& b) {
                     return a.at.*axis < b.at.*axis || (a.at.*axis == b.at.*axis && a.index < b.index);
                   });
  const auto split_side = [&](std::int64_t side) {
    if (side == 0) split(points.first(half), clusters.first(first));
    if (side == 1) split(points.subspan(half), clusters.subspan(first));
  };
  if (points.size() > kManyPoints) {
    parallel_for(0, 2, split_side);
  } else {
    split_side(0);
    split_side(1);
  }
}

bool reaches(const ModelSphere& sphere, double reach, const Vec3d& center, double radius) {
  const double distance = radius + reach * sphere.radius;
  return squared_norm(sphere.center - center) < distance * distance;
}

ClusterGroup make_group(std::span<const PointCluster> clusters, std::size_t begin, std::size_t end) {
  Box box;
  for (std::size_t c = begin; c < end; ++c) box.extend(clusters[c].center);
  ClusterGroup group{begin, end, box.center(), 0.0};
  for (std::size_t c = begin; c < end; ++c) {
    group.radius = std::max(group.radius, norm(clusters[c].center - group.center) + clusters[c].radius);
  }
  // A sphere that just touches a cluster must not be lost to rounding.
  group.radius *= 1.0 + 1e-9;
  return group;
}

}  // namespace

std::vector<PointCluster> cluster_points(std::span<const Vec3d> points, std::size_t size) {
  if (points.empty()) return {};
  std::vector<IndexedPoint> indexed;
  indexed.reserve(points.size());
  for (const Vec3d& p : points) indexed.push_back({p, static_cast<std::int32_t>(indexed.size())});
  std::vector<PointCluster> clusters((points.size() + size - 1) / size);
  split(indexed, clusters);
  return clusters;
}

std::vector<ClusterGroup> group_clusters(std::span<const PointCluster> clusters, std::size_t size) {
  std::vector<ClusterGroup> groups;
  for (std::size_t begin = 0; begin < clusters.size(); begin += size) {
    groups.push_back(make_group(clusters, begin, std::min(begin + size, clusters.size())));
  }
  return groups;
}

void find_spheres(const MetaballModel& model, double reach, const Vec3d& center, double radius,
                  std::vector<std::int32_t>& found) {
  found.clear();
  for (std::size_t i = 0; i < model.spheres.size(); ++i) {
    if (reaches(model.spheres[i], reach, center, radius)) found.push_back(static_cast<std::int32_t>(i));
  }
}

void find_spheres(const MetaballModel& model, double reach, const Vec3d& center, double radius,
                  std::span<const std::int32_t> among, std::vector<std::int32_t>& found) {
  found.clear();
  for (const std::int32_t i : among) {
    if (reaches(model.spheres[static_cast<std::size_t>(i)], reach, center, radius)) found.push_back(i);
  }
}

}  // namespace astrolith
