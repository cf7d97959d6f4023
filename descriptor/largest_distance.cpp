#include "descriptor/largest_distance.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <vector>

#include "numerics/host_device.h"
#include "numerics/reported_loop.h"

namespace astrolith {
namespace {

// The points relative to the centre of their box, the outermost first, one array for each coordinate.
struct ByRadius {
  std::vector<double> x, y, z, radius;

  explicit ByRadius(std::span<const Vec3d> points) {
    Box box;
    for (const Vec3d& p : points) box.extend(p);
    std::vector<Vec3d> centered(points.begin(), points.end());
    for (Vec3d& p : centered) p -= box.center();
    std::sort(centered.begin(), centered.end(),
              [](const Vec3d& a, const Vec3d& b) { return squared_norm(a) > squared_norm(b); });
    for (const Vec3d& p : centered) {
      x.push_back(p.x);
      y.push_back(p.y);
      z.push_back(p.z);
      radius.push_back(norm(p));
    }
  }
};

// The largest squared distance from point i to the points before it.
ASTROLITH_SIMD_CLONES double farthest_squared(const double* x, const double* y, const double* z,
                                              std::int64_t i) {
  double largest = 0;
#pragma omp simd reduction(max : largest)
  for (std::int64_t j = 0; j < i; ++j) {
    const double dx = x[j] - x[i], dy = y[j] - y[i], dz = z[j] - z[i];
    const double d2 = dx * dx + dy * dy + dz * dz;
    largest = d2 > largest ? d2 : largest;
  }
  return largest;
}

}  // namespace

double largest_distance(std::span<const Vec3d> points, const Progress& progress) {
  if (points.size() < 2) return 0;
  const ByRadius p(points);
  const auto n = static_cast<std::int64_t>(points.size());
  const auto row = [&](std::int64_t i) { return farthest_squared(p.x.data(), p.y.data(), p.z.data(), i); };
  // The outermost points give a first bound. By |p - q| <= |p| + |q| only the rows up to `reach` can exceed
  // it.
  double largest = 0;
  const std::int64_t first = std::min<std::int64_t>(n, 64);
  for (std::int64_t i = 0; i < first; ++i) largest = std::max(largest, row(i));
  const double bound = std::sqrt(largest) * (1 - 1e-12);
  const auto reach = std::partition_point(p.radius.begin(), p.radius.end(),
                                          [&](double r) { return r + p.radius[0] >= bound; });
  std::vector<double> rows(static_cast<std::size_t>(reach - p.radius.begin()), 0.0);
  const auto count = static_cast<std::int64_t>(rows.size());
  reported_parallel_for({0, count, count}, progress, "largest distance",
                        [&](std::int64_t i) { rows[static_cast<std::size_t>(i)] = row(i); });
  for (const double r : rows) largest = std::max(largest, r);
  return std::sqrt(largest);
}

}  // namespace astrolith
