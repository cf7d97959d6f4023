// Groups of points that lie close together, so that one list of spheres serves a whole group.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "numerics/vec3.h"

namespace astrolith {

struct PointCluster {
  std::vector<std::int32_t> points;  // indices
  Vec3d center;                      // centre of a ball that holds them
  double radius = 0.0;               // radius of this ball
};

// Splits the points along the longest side of their bounding box until no cluster has more than `size` > 0
// points. Their number is the least, #points / size rounded up, and clusters differ by a point or two.
// Clusters that follow one another lie close together. The result depends on the points only.
std::vector<PointCluster> cluster_points(std::span<const Vec3d> points, std::size_t size);

}  // namespace astrolith
