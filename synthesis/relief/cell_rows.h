// Points of space sorted into cubic cells, and those near a box.
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <vector>

#include "numerics/vec3.h"

namespace astrolith {

class CellRows {
 public:
  // `side` is that of a cell, in the unit of the points.
  CellRows(const std::vector<Vec3d>& points, double side);

  // The points cell by cell. Those of a cell stand together, as order()[first_in_cell(c)] and so on; cells
  // without points do not count.
  const std::vector<std::uint32_t>& order() const { return order_; }
  std::size_t cells() const { return cells_.size() - 1; }
  double side() const { return side_; }
  std::uint32_t first_in_cell(std::size_t c) const { return cells_[c].first; }

  // The number of the part that a point lies in, where its cell is cut into parts^3; below parts^3.
  std::size_t part_of(const Vec3d& p, int parts) const {
    const auto along = [&](double at, std::size_t axis) {
      const double in_cell = (at - corner_[axis]) * inverse_side_ - static_cast<double>(cell(at, axis));
      return static_cast<std::size_t>(std::clamp(static_cast<int>(in_cell * parts), 0, parts - 1));
    };
    const auto n = static_cast<std::size_t>(parts);
    return along(p.x, 0) + n * (along(p.y, 1) + n * along(p.z, 2));
  }

  // Calls visit(first, end) for ranges of cells that hold all points within `radius` of the points of a box.
  template <typename Visit>
  void for_each_row(const Box& box, double radius, const Visit& visit) const {
    const CellRange y = range(box.min.y, box.max.y, radius, 1), z = range(box.min.z, box.max.z, radius, 2);
    for (std::int64_t k = z.first; k <= z.last; ++k) {
      const double off_z = gap(k, 2, box.min.z, box.max.z), left_z = radius * radius - off_z * off_z;
      for (std::int64_t j = y.first; j <= y.last; ++j) {
        const auto row = static_cast<std::size_t>(j + count_[1] * k);
        const auto begin = cells_.begin() + rows_[row], end = cells_.begin() + rows_[row + 1];
        if (begin == end) continue;
        // A row that passes at some distance has less within the radius.
        const double off_y = gap(j, 1, box.min.y, box.max.y), left = left_z - off_y * off_y;
        if (left < 0.0) continue;
        const CellRange x = range(box.min.x, box.max.x, std::sqrt(left), 0);
        const auto before = [](const Cell& cell, std::int64_t at) { return cell.x < at; };
        const auto first = std::lower_bound(begin, end, x.first, before),
                   last = std::lower_bound(first, end, x.last + 1, before);
        if (first != last) {
          visit(static_cast<std::size_t>(first - cells_.begin()),
                static_cast<std::size_t>(last - cells_.begin()));
        }
      }
    }
  }

 private:
  struct CellRange {
    std::int64_t first, last;
  };
  // A cell with points: its number in the row, and its first point in the order.
  struct Cell {
    std::int64_t x;
    std::uint32_t first;
  };
  std::int64_t cell(double at, std::size_t axis) const {
    const double number = (at - corner_[axis]) * inverse_side_;
    return static_cast<std::int64_t>(std::clamp(number, 0.0, last_[axis]));
  }
  // How far a cell lies from an interval along an axis, a little less for rounding.
  double gap(std::int64_t number, std::size_t axis, double low, double high) const {
    constexpr double kSlack = 1e-6;  // of a cell
    const double first = corner_[axis] + side_ * (static_cast<double>(number) - kSlack),
                 last = first + side_ * (1.0 + 2.0 * kSlack);
    return std::max({0.0, first - high, low - last});
  }
  CellRange range(double low, double high, double radius, std::size_t axis) const {
    return {cell(low - radius, axis), cell(high + radius, axis)};
  }

  double side_, inverse_side_;
  std::array<double, 3> corner_{}, last_{};  // last_: the numbers of the last cells
  std::array<std::int64_t, 3> count_{1, 1, 1};
  std::vector<std::uint32_t> order_;
  std::vector<Cell> cells_;                // row by row, and one at the end
  std::vector<std::uint32_t> rows_{0, 0};  // (rows + 1) first cell of each row along x
};

}  // namespace astrolith
