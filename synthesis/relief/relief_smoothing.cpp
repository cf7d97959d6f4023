#include "synthesis/relief/relief_smoothing.h"

#include <cmath>

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

ReliefPoints::ReliefPoints(const std::vector<ReliefPlace>& places, double spacing) {
  std::vector<Box> boxes;
  boxes.reserve(places.size());
  for (const ReliefPlace& p : places) {
    at_.push_back(spacing * along_axes(p, double{p.w}, p.u, p.v));
    normals_.push_back(along_axes(p, double{p.normal.x}, double{p.normal.y}, double{p.normal.z}));
    weights_.push_back(p.weight / 65535.0);
    boxes.push_back({at_.back(), at_.back()});
  }
  tree_ = BoxTree(boxes);
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
