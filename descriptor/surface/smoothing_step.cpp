#include "descriptor/surface/smoothing_step.h"

#include <algorithm>

#include "geometry/points/point_tree_internal.h"
#include "numerics/tangent_frame.h"

namespace astrolith {
namespace {

// Wide enough that points of the nominal mean square distance keep a third for themselves.
constexpr double kStepReach = 2.2;  // edges

// A neighbour of a point: its offset along two tangents, its squared distance and its weight.
struct Neighbour {
  std::uint32_t point;
  double x, y, squared, weight;
};

std::vector<Neighbour> find_neighbours(const EvenedSurface& even, const PointTree& tree, std::size_t i) {
  const double reach = kStepReach * even.edge;
  const Tangents<double> along = crossed_tangents(even.normals[i]);
  std::vector<Neighbour> neighbours;
  for (const auto& [j, squared] : tree.within(even.points[i], reach)) {
    if (j == i || dot(even.normals[i], even.normals[j]) <= 0.0) continue;
    const Vec3d offset = even.points[j] - even.points[i];
    neighbours.push_back({j, dot(offset, along.first), dot(offset, along.second), squared,
                          std::max(0.0, 1.0 - squared / (reach * reach))});
  }
  return neighbours;
}

// Makes the weighted mean of the offsets 0, by weights times 1 - lean . offset. Where that is impossible, as
// at a border, the mean comes near 0, since no weight becomes negative.
void center(std::vector<Neighbour>& neighbours) {
  double xx = 0.0, xy = 0.0, yy = 0.0, x = 0.0, y = 0.0;
  for (const Neighbour& n : neighbours) {
    xx += n.weight * n.x * n.x, xy += n.weight * n.x * n.y, yy += n.weight * n.y * n.y;
    x += n.weight * n.x, y += n.weight * n.y;
  }
  const double determinant = xx * yy - xy * xy;
  if (!(determinant > 1e-6 * xx * yy)) return;
  const double lean_x = (yy * x - xy * y) / determinant, lean_y = (xx * y - xy * x) / determinant;
  for (Neighbour& n : neighbours) n.weight *= std::max(0.0, 1.0 - lean_x * n.x - lean_y * n.y);
}

// Shares of the neighbours whose mean is the point itself, and whose mean square distance is the nominal one;
// the rest is the point's own. Uneven points then neither drift nor blur more at one place than at another.
std::vector<SmoothingShare> shares_around(const EvenedSurface& even, const PointTree& tree, std::size_t i) {
  std::vector<Neighbour> neighbours = find_neighbours(even, tree, i);
  center(neighbours);
  double squares = 0.0, weights = 0.0;
  for (const Neighbour& n : neighbours) {
    squares += n.weight * n.squared;
    weights += n.weight;
  }
  // No share is negative, else the steps would grow without bound where points are crowded, as in a crease.
  const double factor =
      weights > 0.0 ? std::min(kMeanSquare * even.edge * even.edge / squares, 1.0 / weights) : 0.0;
  std::vector<SmoothingShare> shares;
  double own = 1.0;
  for (const Neighbour& n : neighbours) {
    shares.push_back({n.point, factor * n.weight});
    own -= factor * n.weight;
  }
  shares.push_back({static_cast<std::uint32_t>(i), own});
  return shares;
}

}  // namespace

SmoothingStep::SmoothingStep(const EvenedSurface& even) : starts_(even.points.size() + 1, 0) {
  const std::size_t n = even.points.size();
  const PointTree tree(even.points);
  std::vector<std::vector<SmoothingShare>> shares(n);
  parallel_for(0, static_cast<std::int64_t>(n), [&](std::int64_t index) {
    const auto i = static_cast<std::size_t>(index);
    shares[i] = shares_around(even, tree, i);
  });
  for (std::size_t i = 0; i < n; ++i) {
    shares_.insert(shares_.end(), shares[i].begin(), shares[i].end());
    starts_[i + 1] = shares_.size();
  }
}

}  // namespace astrolith
