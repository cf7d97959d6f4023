#include "geometry/nearest_neighbours.h"

#include <algorithm>
#include <cmath>
#include <nanoflann.hpp>
#include <string>

#include "numerics/errors.h"
#include "numerics/parallel_for.h"

namespace astrolith {
namespace {

// The face that nanoflann wants of a set of points.
struct Cloud {
  std::span<const Vec3d> points;

  std::size_t kdtree_get_point_count() const { return points.size(); }
  double kdtree_get_pt(std::size_t i, std::size_t axis) const {
    const Vec3d& p = points[i];
    return axis == 0 ? p.x : axis == 1 ? p.y : p.z;
  }
  template <typename Bounds>
  bool kdtree_get_bbox(Bounds&) const {
    return false;  // let it compute them
  }
};

using Tree =
    nanoflann::KDTreeSingleIndexAdaptor<nanoflann::L2_Simple_Adaptor<double, Cloud>, Cloud, 3, std::uint32_t>;

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
  const Cloud cloud{points};
  const Tree tree(3, cloud, nanoflann::KDTreeSingleIndexAdaptorParams(16));
  const auto size = static_cast<std::size_t>(k);
  std::vector<std::uint32_t> neighbours(points.size() * size);
  parallel_for(
      0, static_cast<std::int64_t>(points.size()),
      [&](std::int64_t index) {
        const auto i = static_cast<std::uint32_t>(index);
        // One more, since the point finds itself; where many lie in one place it may find only others.
        std::vector<std::uint32_t> found(size + 1);
        std::vector<double> squared(size + 1);
        const double at[3] = {points[i].x, points[i].y, points[i].z};
        tree.knnSearch(at, size + 1, found.data(), squared.data());
        std::erase(found, i);
        std::copy_n(found.begin(), size, neighbours.begin() + static_cast<std::ptrdiff_t>(i * size));
      },
      64);
  return neighbours;
}

}  // namespace astrolith
