// Points sorted into the cells of a uniform grid, to find all neighbours within one fixed radius.
#pragma once

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <utility>
#include <vector>

#include "numerics/vec3.h"

namespace astrolith {

class PointGrid {
 public:
  // Keeps a reference to the points. radius > 0.
  PointGrid(const std::vector<Vec3d>& points, double radius) : points_(points), radius_(radius) {
    for (const Vec3d& p : points) box_.extend(p);
    // The key of a cell has 21 bits for each axis, so that cells have a smallest size.
    cell_ = std::max(radius, box_.diagonal() / (kMostCells - 2));
    sorted_.reserve(points.size());
    for (std::uint32_t i = 0; i < points.size(); ++i) sorted_.emplace_back(key(cell_of(points[i])), i);
    std::sort(sorted_.begin(), sorted_.end());
  }

  // Calls visit(index, squared distance) for each other point at a distance below the radius, in an order
  // that depends on the points and the radius alone.
  template <typename Visit>
  void for_each_neighbour(std::uint32_t i, const Visit& visit) const {
    const Cell center = cell_of(points_[i]);
    for (std::int64_t x = center.x - 1; x <= center.x + 1; ++x) {
      for (std::int64_t y = center.y - 1; y <= center.y + 1; ++y) {
        // The three cells along z have consecutive keys.
        const std::uint64_t last = key({x, y, center.z + 1});
        auto it = std::lower_bound(sorted_.begin(), sorted_.end(),
                                   std::pair{key({x, y, center.z - 1}), std::uint32_t{0}});
        for (; it != sorted_.end() && it->first <= last; ++it) {
          const double d2 = squared_norm(points_[it->second] - points_[i]);
          if (it->second != i && d2 < radius_ * radius_) visit(it->second, d2);
        }
      }
    }
  }

 private:
  static constexpr int kMostCells = 1 << 20;  // along an axis
  struct Cell {
    std::int64_t x, y, z;
  };
  Cell cell_of(const Vec3d& p) const {
    const auto along = [&](double value, double low) {
      // At least 1, so that lower neighbours have numbers of at least 0.
      return static_cast<std::int64_t>(std::floor((value - low) / cell_)) + 1;
    };
    return {along(p.x, box_.min.x), along(p.y, box_.min.y), along(p.z, box_.min.z)};
  }
  static std::uint64_t key(const Cell& c) {
    return static_cast<std::uint64_t>(c.x) << 42 | static_cast<std::uint64_t>(c.y) << 21 |
           static_cast<std::uint64_t>(c.z);
  }

  const std::vector<Vec3d>& points_;
  double radius_;
  double cell_ = 0;
  Box box_;
  std::vector<std::pair<std::uint64_t, std::uint32_t>> sorted_;  // (cell, point)
};

}  // namespace astrolith
