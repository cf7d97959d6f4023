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
    for_each_row(Box{p, p}, radius, [&](std::uint32_t first, std::uint32_t end) {
      for (std::uint32_t k = first; k < end; ++k) {
        const std::uint32_t i = order_[k];
        const double squared = squared_norm(at_[i] - p), facing = dot(normals_[i], normal);
        if (squared < radius * radius && facing > 0.0) visit(i, squared, facing);
      }
    });
  }

  // The places cell by cell. The places of a cell stand together, as order()[first_in_cell(c)] and so on.
  const std::vector<std::uint32_t>& order() const { return order_; }
  std::size_t cells() const { return cells_.size() - 1; }
  double cell_side() const { return cell_; }  // length units
  std::uint32_t first_in_cell(std::size_t c) const { return cells_[c].first; }

  // Calls visit(first, end) for ranges of order() that hold all places within `radius` of the points of a
  // box, in the order of for_each_near().
  template <typename Visit>
  void for_each_row(const Box& box, double radius, const Visit& visit) const {
    const CellRange y = range(box.min.y, box.max.y, radius, 1), z = range(box.min.z, box.max.z, radius, 2);
    for (std::int64_t k = z.first; k <= z.last; ++k) {
      for (std::int64_t j = y.first; j <= y.last; ++j) {
        // A row that passes at some distance has less within the radius.
        const double off_y = gap(j, 1, box.min.y, box.max.y), off_z = gap(k, 2, box.min.z, box.max.z);
        const double left = radius * radius - off_y * off_y - off_z * off_z;
        if (left < 0.0) continue;
        const CellRange x = range(box.min.x, box.max.x, std::sqrt(left), 0);
        const auto row = static_cast<std::size_t>(j + count_[1] * k);
        const auto before = [](const Cell& cell, std::int64_t at) { return cell.x < at; };
        const auto begin = cells_.begin() + rows_[row], end = cells_.begin() + rows_[row + 1];
        const auto first = std::lower_bound(begin, end, x.first, before),
                   last = std::lower_bound(first, end, x.last + 1, before);
        if (first != last) visit(first->first, last->first);
      }
    }
  }

 private:
  struct CellRange {
    std::int64_t first, last;
  };
  // A cell with places: its number in the row, and its first place in the order.
  struct Cell {
    std::int64_t x;
    std::uint32_t first;
  };
  std::int64_t cell(double at, std::size_t axis) const {
    const double number = std::floor((at - corner_[axis]) / cell_);
    return static_cast<std::int64_t>(std::clamp(number, 0.0, static_cast<double>(count_[axis] - 1)));
  }
  // How far a cell lies from an interval along an axis, a little less for rounding.
  double gap(std::int64_t number, std::size_t axis, double low, double high) const {
    constexpr double kSlack = 1e-6;  // of a cell
    const double first = corner_[axis] + cell_ * (static_cast<double>(number) - kSlack),
                 last = first + cell_ * (1.0 + 2.0 * kSlack);
    return std::max({0.0, first - high, low - last});
  }
  CellRange range(double low, double high, double radius, std::size_t axis) const {
    return {cell(low - radius, axis), cell(high + radius, axis)};
  }

  std::vector<Vec3d> at_, normals_;
  std::vector<double> weights_;
  double cell_;  // length units
  std::array<double, 3> corner_{};
  std::array<std::int64_t, 3> count_{1, 1, 1};
  std::vector<std::uint32_t> order_;
  std::vector<Cell> cells_;                // row by row, and one at the end
  std::vector<std::uint32_t> rows_{0, 0};  // (rows + 1) first cell of each row along x
};

// Means of the heights around each place. The weights (1 - d^2 / R^2)^4 with R = sqrt(8) sigma have the
// standard deviation sigma (length units) along an axis, nearly. In wide means the places of a cell count as
// one.
std::vector<double> smoothed_heights(const ReliefPoints& points, const std::vector<double>& heights,
                                     double sigma);

// The means of three fields at once, which take hardly longer than those of one.
using ThreeFields = std::array<std::vector<double>, 3>;
ThreeFields smoothed_fields(const ReliefPoints& points, const ThreeFields& fields, double sigma);

// The means of three fields around the places of cells all over the body: all of them, or some thousand.
struct SampledMeans {
  std::vector<std::uint32_t> places;
  ThreeFields means;  // around each of these
};
SampledMeans sampled_means(const ReliefPoints& points, const ThreeFields& fields, double sigma);

}  // namespace astrolith
