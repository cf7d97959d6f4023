#include "descriptor/surflet_histogram.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <string>
#include <vector>

#include "descriptor/local_features.h"
#include "descriptor/pair_count.h"
#include "numerics/errors.h"
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

constexpr std::size_t kMostSurfletPoints = std::size_t{1} << 24;

[[noreturn]] void refuse(const std::string& what) { throw InputError("shape histogram: " + what); }

bool is_finite(const Vec3d& v) { return std::isfinite(v.x) && std::isfinite(v.y) && std::isfinite(v.z); }

void check(std::span<const Vec3d> points, std::span<const Vec3d> normals, int bins) {
  if (bins < kMinBins || bins > kMaxBins) {
    refuse(std::to_string(bins) + " bins are outside " + std::to_string(kMinBins) + " to " +
           std::to_string(kMaxBins) + "; 5 is usual");
  }
  if (points.size() != normals.size()) {
    refuse(std::to_string(points.size()) + " points have " + std::to_string(normals.size()) +
           " normals; give one for each");
  }
  if (points.size() > kMostSurfletPoints) {
    refuse(std::to_string(points.size()) + " points are more than " + std::to_string(kMostSurfletPoints) +
           "; sample fewer");
  }
  for (std::size_t i = 0; i < points.size(); ++i) {
    if (!is_finite(points[i]) || !is_finite(normals[i])) {
      refuse("point " + std::to_string(i) + " is not finite; leave it out");
    }
  }
}

std::vector<Vec3d> unit_vectors(std::span<const Vec3d> vectors) {
  std::vector<Vec3d> unit(vectors.begin(), vectors.end());
  for (Vec3d& v : unit) v = normalized(v);
  return unit;
}

// The points in units of their largest distance, with the middle of their box at 0.
std::vector<Vec3d> scaled(std::span<const Vec3d> points, double max_distance) {
  Box box;
  for (const Vec3d& p : points) box.extend(p);
  const double scale = max_distance > 0 ? 1 / max_distance : 0;
  std::vector<Vec3d> result(points.begin(), points.end());
  for (Vec3d& p : result) p = scale * (p - box.center());
  return result;
}

// Reorders counts from (local, surflet) to (surflet, local).
std::vector<std::uint64_t> local_last(std::span<const std::uint64_t> counts, std::size_t num_local) {
  const std::size_t bins = counts.size() / num_local;
  std::vector<std::uint64_t> result(counts.size());
  for (std::size_t l = 0; l < num_local; ++l) {
    for (std::size_t b = 0; b < bins; ++b) result[b * num_local + l] = counts[l * bins + b];
  }
  return result;
}

PairInput pair_input(std::span<const Vec3d> points, std::vector<Vec3d> unit_normals,
                     std::vector<std::int32_t> local, int num_local, int bins, const Progress& progress) {
  const double max_distance = largest_distance(points, at_beginning(progress));
  return {
      scaled(points, max_distance), std::move(unit_normals), std::move(local), num_local, bins, max_distance};
}

ShapeHistogram make_histogram(const PairInput& input, std::span<const std::uint64_t> counts) {
  ShapeHistogram histogram;
  histogram.bins = input.bins;
  histogram.max_distance = input.max_distance;
  histogram.counts = local_last(counts, static_cast<std::size_t>(input.num_local));
  const std::uint64_t n = input.points.size();
  histogram.pairs = n > 1 ? n * (n - 1) / 2 : 0;
  return histogram;
}

std::vector<std::uint64_t> pair_counts(const PairInput& input, const Progress& progress,
                                       const PairCounter& counter) {
  const auto count = [&](const auto& how) {
    return how(input.points, input.normals, input.local, input.num_local, input.bins, progress);
  };
  return counter ? count(counter) : count(count_pairs);
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

std::vector<double> ShapeHistogram::frequencies() const {
  std::vector<double> f(counts.begin(), counts.end());
  for (double& value : f) value /= static_cast<double>(std::max<std::uint64_t>(pairs, 1));
  return f;
}

ShapeHistogram surflet_histogram(std::span<const Vec3d> points, std::span<const Vec3d> normals, int bins,
                                 const Progress& progress, const PairCounter& counter) {
  check(points, normals, bins);
  const PairInput input = pair_input(points, unit_vectors(normals),
                                     std::vector<std::int32_t>(points.size(), 0), 1, bins, progress);
  return make_histogram(input, pair_counts(input, progress, counter));
}

PairInput ahd_input(std::span<const Vec3d> points, std::span<const Vec3d> normals,
                    std::span<const double> curvatures, int bins, const Progress& progress) {
  check(points, normals, bins);
  if (curvatures.size() != points.size()) {
    refuse(std::to_string(points.size()) + " points have " + std::to_string(curvatures.size()) +
           " curvatures; give one for each");
  }
  for (std::size_t i = 0; i < curvatures.size(); ++i) {
    if (!std::isfinite(curvatures[i])) {
      refuse("the curvature of point " + std::to_string(i) + " is not finite; give 0 where it is unknown");
    }
  }
  std::vector<Vec3d> unit = unit_vectors(normals);
  std::vector<std::int32_t> local = local_codes(points, unit, curvatures, bins);
  return pair_input(points, std::move(unit), std::move(local), bins * bins, bins, progress);
}

ShapeHistogram ahd_histogram(const PairInput& input, std::span<const std::uint64_t> counts) {
  ShapeHistogram histogram = make_histogram(input, counts);
  histogram.features = PairFeatures::ahd;
  return histogram;
}

ShapeHistogram ahd_histogram(std::span<const Vec3d> points, std::span<const Vec3d> normals,
                             std::span<const double> curvatures, int bins, const Progress& progress,
                             const PairCounter& counter) {
  const PairInput input = ahd_input(points, normals, curvatures, bins, progress);
  return ahd_histogram(input, pair_counts(input, progress, counter));
}

}  // namespace astrolith
