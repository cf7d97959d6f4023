#include "synthesis/relief/cell_rows.h"

#include <numeric>
#include <tuple>

namespace astrolith {

CellRows::CellRows(const std::vector<Vec3d>& points, double side) : side_(side), inverse_side_(1.0 / side) {
  cells_.push_back({0, 0});
  if (points.empty()) return;
  Box box;
  for (const Vec3d& p : points) box.extend(p);
  corner_ = {box.min.x, box.min.y, box.min.z};
  const Vec3d extent = box.extent();
  count_ = {1 + static_cast<std::int64_t>(extent.x / side_), 1 + static_cast<std::int64_t>(extent.y / side_),
            1 + static_cast<std::int64_t>(extent.z / side_)};
  for (std::size_t axis = 0; axis < 3; ++axis) last_[axis] = static_cast<double>(count_[axis] - 1);
  struct Keyed {
    std::int64_t row, x;
    std::uint32_t point;
  };
  std::vector<Keyed> keys(points.size());
  for (std::size_t i = 0; i < keys.size(); ++i) {
    const Vec3d& p = points[i];
    keys[i] = {cell(p.y, 1) + count_[1] * cell(p.z, 2), cell(p.x, 0), static_cast<std::uint32_t>(i)};
  }
  std::sort(keys.begin(), keys.end(), [](const Keyed& a, const Keyed& b) {
    return std::tie(a.row, a.x, a.point) < std::tie(b.row, b.x, b.point);
  });
  cells_.clear();
  order_.resize(keys.size());
  rows_.assign(static_cast<std::size_t>(count_[1] * count_[2]) + 1, 0);
  for (std::size_t k = 0; k < keys.size(); ++k) {
    order_[k] = keys[k].point;
    if (k > 0 && keys[k].row == keys[k - 1].row && keys[k].x == keys[k - 1].x) continue;
    cells_.push_back({keys[k].x, static_cast<std::uint32_t>(k)});
    ++rows_[static_cast<std::size_t>(keys[k].row) + 1];
  }
  std::partial_sum(rows_.begin(), rows_.end(), rows_.begin());
  cells_.push_back({0, static_cast<std::uint32_t>(keys.size())});
}

}  // namespace astrolith
