#include <algorithm>

#include "estimation/shape/model/model_evaluation_internal.h"

namespace astrolith {
namespace {

bool reaches(const ModelSphere& sphere, double reach, const Vec3d& center, double radius) {
  const double distance = radius + reach * sphere.radius;
  return squared_norm(sphere.center - center) < distance * distance;
}

ClusterGroup group_of(std::span<const PointCluster> clusters, std::size_t begin, std::size_t end) {
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

std::vector<ClusterGroup> group_clusters(std::span<const PointCluster> clusters, std::size_t size) {
  std::vector<ClusterGroup> groups;
  for (std::size_t begin = 0; begin < clusters.size(); begin += size) {
    groups.push_back(group_of(clusters, begin, std::min(begin + size, clusters.size())));
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
