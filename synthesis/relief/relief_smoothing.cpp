#include "synthesis/relief/relief_smoothing.h"

#include <cmath>
#include <numeric>

#include "numerics/parallel_for.h"

namespace astrolith {
namespace {

Vec3d along_axes(const ReliefPlace& place, double along, double u, double v) {
  double of[3];
  of[place.axis] = along;
  of[(place.axis + 1) % 3] = u;
  of[(place.axis + 2) % 3] = v;
  return {of[0], of[1], of[2]};
}

}  // namespace

ReliefPoints::ReliefPoints(const std::vector<ReliefPlace>& places, double spacing) : cell_(4.0 * spacing) {
  Box box;
  for (const ReliefPlace& p : places) {
    at_.push_back(spacing * along_axes(p, double{p.w}, p.u, p.v));
    normals_.push_back(along_axes(p, double{p.normal.x}, double{p.normal.y}, double{p.normal.z}));
    weights_.push_back(p.weight / 65535.0);
    box.extend(at_.back());
  }
  if (places.empty()) return;
  corner_ = {box.min.x, box.min.y, box.min.z};
  const Vec3d extent = box.extent();
  count_ = {1 + static_cast<std::int64_t>(extent.x / cell_), 1 + static_cast<std::int64_t>(extent.y / cell_),
            1 + static_cast<std::int64_t>(extent.z / cell_)};
  std::vector<std::int64_t> keys;
  for (const Vec3d& p : at_) keys.push_back(key(cell(p.x, 0), cell(p.y, 1), cell(p.z, 2)));
  order_.resize(places.size());
  std::iota(order_.begin(), order_.end(), 0u);
  std::stable_sort(order_.begin(), order_.end(),
                   [&](std::uint32_t a, std::uint32_t b) { return keys[a] < keys[b]; });
  for (const std::uint32_t i : order_) keys_.push_back(keys[i]);
}

std::vector<double> smoothed_heights(const ReliefPoints& points, const std::vector<double>& heights,
                                     double sigma) {
  const double radius = std::sqrt(8.0) * sigma, inverse = 1.0 / (radius * radius);
  std::vector<double> means(heights.size());
  parallel_for(
      0, static_cast<std::int64_t>(heights.size()),
      [&](std::int64_t number) {
        const auto i = static_cast<std::size_t>(number);
        double total = 0.0, sum = 0.0;
        points.for_each_near(points.at(i), points.normal(i), radius,
                             [&](std::uint32_t k, double squared, double facing) {
                               const double near = 1.0 - squared * inverse, square = near * near;
                               const double weight = square * square * facing * points.weight(k);
                               total += weight;
                               sum += weight * heights[k];
                             });
        means[i] = total > 0.0 ? sum / total : heights[i];
      },
      64);
  return means;
}

}  // namespace astrolith
