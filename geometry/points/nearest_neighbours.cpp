#include "geometry/points/nearest_neighbours.h"

#include <algorithm>
#include <cmath>
#include <string>

#include "geometry/points/point_tree_internal.h"
#include "numerics/errors.h"
#include "numerics/parallel_for.h"

namespace astrolith {
namespace {

void check(std::span<const Vec3d> points, int k) {
  if (k < 1 || static_cast<std::size_t>(k) >= points.size()) {
    throw InputError("nearest neighbours: " + std::to_string(k) + " of " + std::to_string(points.size()) +
                     " points; there must be more points than neighbours");
  }
  for (const Vec3d& p : points) {
    if (!std::isfinite(squared_norm(p))) throw InputError("nearest neighbours: a point is not finite");
  }
}

}  // namespace

std::vector<std::uint32_t> nearest_neighbours(std::span<const Vec3d> points, int k) {
  check(points, k);
  const PointTree tree(points);
  const auto size = static_cast<std::size_t>(k);
  std::vector<std::uint32_t> neighbours(points.size() * size);
  parallel_for(
      0, static_cast<std::int64_t>(points.size()),
      [&](std::int64_t index) {
        const auto i = static_cast<std::uint32_t>(index);
        // One more neighbour is sought, since the point finds itself. Where many points lie in one place, it
        // may find others only.
        std::vector<std::uint32_t> found = tree.nearest(points[i], size + 1);
        std::erase(found, i);
        std::copy_n(found.begin(), size, neighbours.begin() + static_cast<std::ptrdiff_t>(i * size));
      },
      64);
  return neighbours;
}

}  // namespace astrolith
