// A k-d tree (nanoflann) that finds the neighbours of any place among a set of points.
#pragma once

#include <cstdint>
#include <nanoflann.hpp>
#include <span>
#include <utility>
#include <vector>

#include "numerics/vec3.h"

namespace astrolith {

class PointTree {
 public:
  // Keeps a reference to the points, which must be finite.
  explicit PointTree(std::span<const Vec3d> points)
      : cloud_{points}, tree_(3, cloud_, nanoflann::KDTreeSingleIndexAdaptorParams(16)) {}
  PointTree(const PointTree&) = delete;
  PointTree& operator=(const PointTree&) = delete;

  // (index, squared distance) of all points at most `radius` away, always in the same order.
  std::vector<std::pair<std::uint32_t, double>> within(const Vec3d& place, double radius) const {
    std::vector<std::pair<std::uint32_t, double>> found;
    nanoflann::SearchParams unsorted;
    unsorted.sorted = false;
    // nanoflann takes the squared radius and leaves out points at exactly that distance.
    tree_.radiusSearch(&place.x, radius * radius * (1 + 1e-12), found, unsorted);
    return found;
  }

  // The indices of the `count` nearest points, the nearest first; of all points when there are fewer.
  std::vector<std::uint32_t> nearest(const Vec3d& place, std::size_t count) const {
    std::vector<std::uint32_t> indices(count);
    std::vector<double> squared(count);
    indices.resize(tree_.knnSearch(&place.x, count, indices.data(), squared.data()));
    return indices;
  }

 private:
  struct Cloud {
    std::span<const Vec3d> points;
    std::size_t kdtree_get_point_count() const { return points.size(); }
    double kdtree_get_pt(std::size_t i, std::size_t axis) const {
      return axis == 0 ? points[i].x : axis == 1 ? points[i].y : points[i].z;
    }
    template <typename Bounds>
    bool kdtree_get_bbox(Bounds&) const {
      return false;
    }
  };
  Cloud cloud_;
  nanoflann::KDTreeSingleIndexAdaptor<nanoflann::L2_Simple_Adaptor<double, Cloud>, Cloud, 3, std::uint32_t>
      tree_;
};

}  // namespace astrolith
