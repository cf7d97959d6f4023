// The places of a relief as points of the surface, and means of heights around them.
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <vector>

#include "numerics/vec3.h"
#include "synthesis/relief/relief_places.h"

namespace astrolith {

// Places in length units, and how those near a point are found.
class ReliefPoints {
 public:
  ReliefPoints(const std::vector<ReliefPlace>& places, double spacing);

  std::size_t size() const { return at_.size(); }
  const Vec3d& at(std::size_t i) const { return at_[i]; }
  const Vec3d& normal(std::size_t i) const { return normals_[i]; }  // outwards, unit length
  double weight(std::size_t i) const { return weights_[i]; }        // in the blend of the maps, 0 .. 1

  // Calls visit(number, squared distance, cosine of the angle between the normals) for the places within
  // `radius` of a point that face the same side, cell by cell.
  template <typename Visit>
  void for_each_near(const Vec3d& p, const Vec3d& normal, double radius, const Visit& visit) const {
    const std::array<CellRange, 3> cells{range(p.x, radius, 0), range(p.y, radius, 1), range(p.z, radius, 2)};
    for (std::int64_t z = cells[2].first; z <= cells[2].last; ++z) {
      for (std::int64_t y = cells[1].first; y <= cells[1].last; ++y) {
        const std::int64_t last = key(cells[0].last, y, z);
        auto next = std::lower_bound(keys_.begin(), keys_.end(), key(cells[0].first, y, z));
        for (; next != keys_.end() && *next <= last; ++next) {
          const std::uint32_t i = order_[static_cast<std::size_t>(next - keys_.begin())];
          const double squared = squared_norm(at_[i] - p), facing = dot(normals_[i], normal);
          if (squared < radius * radius && facing > 0.0) visit(i, squared, facing);
        }
      }
    }
  }

 private:
  // Cells of the box of the places, in one row of them.
  struct CellRange {
    std::int64_t first, last;
  };
  std::int64_t cell(double at, std::size_t axis) const {
    const double number = std::floor((at - corner_[axis]) / cell_);
    return static_cast<std::int64_t>(std::clamp(number, 0.0, static_cast<double>(count_[axis] - 1)));
  }
  CellRange range(double at, double radius, std::size_t axis) const {
    return {cell(at - radius, axis), cell(at + radius, axis)};
  }
  std::int64_t key(std::int64_t x, std::int64_t y, std::int64_t z) const {
    return x + count_[0] * (y + count_[1] * z);
  }

  std::vector<Vec3d> at_, normals_;
  std::vector<double> weights_;
  double cell_;  // length units
  std::array<double, 3> corner_{};
  std::array<std::int64_t, 3> count_{1, 1, 1};
  std::vector<std::int64_t> keys_;    // of the cells of the places, ascending
  std::vector<std::uint32_t> order_;  // the place of each key
};

// Means of the heights around each place. The weights (1 - d^2 / R^2)^4 with R = sqrt(8) sigma have the
// standard deviation sigma (length units) along an axis, nearly.
std::vector<double> smoothed_heights(const ReliefPoints& points, const std::vector<double>& heights,
                                     double sigma);

}  // namespace astrolith
