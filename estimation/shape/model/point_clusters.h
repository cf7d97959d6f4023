// Points grouped by nearness, so that what concerns one concerns its group.
#pragma once

#include <cstdint>
#include <vector>

#include "numerics/vec3.h"

namespace astrolith {

struct PointCluster {
  std::vector<std::int32_t> points;  // indices
  Vec3d center;                      // of a sphere that holds them
  double radius = 0.0;
};

// Splits at the median of the longest side until at most `size` points are left. Deterministic.
std::vector<PointCluster> cluster_points(const std::vector<Vec3d>& points, std::size_t size);

}  // namespace astrolith
