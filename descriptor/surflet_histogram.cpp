#include "descriptor/surflet_histogram.h"

#include <algorithm>
#include <cmath>
#include <string>
#include <vector>

#include "descriptor/largest_distance.h"
#include "descriptor/local_features.h"
#include "descriptor/pair_count.h"
#include "numerics/errors.h"

namespace astrolith {
namespace {

constexpr std::size_t kMaxPoints = std::size_t{1} << 24;

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
  if (points.size() > kMaxPoints) {
    refuse(std::to_string(points.size()) + " points are more than " + std::to_string(kMaxPoints) +
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

// In units of the largest distance, the middle of the box at 0.
std::vector<Vec3d> scaled(std::span<const Vec3d> points, double max_distance) {
  Box box;
  for (const Vec3d& p : points) box.extend(p);
  const double scale = max_distance > 0 ? 1 / max_distance : 0;
  std::vector<Vec3d> result(points.begin(), points.end());
  for (Vec3d& p : result) p = scale * (p - box.center());
  return result;
}

// From (local, surflet) to (surflet, local).
std::vector<std::uint64_t> local_last(const std::vector<std::uint64_t>& counts, std::size_t num_local) {
  const std::size_t bins = counts.size() / num_local;
  std::vector<std::uint64_t> result(counts.size());
  for (std::size_t l = 0; l < num_local; ++l) {
    for (std::size_t b = 0; b < bins; ++b) result[b * num_local + l] = counts[l * bins + b];
  }
  return result;
}

ShapeHistogram histogram_of(std::span<const Vec3d> points, std::span<const Vec3d> unit_normals,
                            std::span<const std::int32_t> local, int num_local, int bins,
                            const Progress& progress, const PairCounter& counter) {
  ShapeHistogram histogram;
  histogram.bins = bins;
  histogram.max_distance = largest_distance(points);
  const std::vector<Vec3d> in_unit = scaled(points, histogram.max_distance);
  const auto counts = counter ? counter(in_unit, unit_normals, local, num_local, bins, progress)
                              : count_pairs(in_unit, unit_normals, local, num_local, bins, progress);
  histogram.counts = local_last(counts, static_cast<std::size_t>(num_local));
  const std::uint64_t n = points.size();
  histogram.pairs = n > 1 ? n * (n - 1) / 2 : 0;
  return histogram;
}

}  // namespace

std::vector<double> ShapeHistogram::frequencies() const {
  std::vector<double> f(counts.begin(), counts.end());
  for (double& value : f) value /= static_cast<double>(std::max<std::uint64_t>(pairs, 1));
  return f;
}

ShapeHistogram surflet_histogram(std::span<const Vec3d> points, std::span<const Vec3d> normals, int bins,
                                 const Progress& progress, const PairCounter& counter) {
  check(points, normals, bins);
  const std::vector<std::int32_t> all_alike(points.size(), 0);
  return histogram_of(points, unit_vectors(normals), all_alike, 1, bins, progress, counter);
}

ShapeHistogram ahd_histogram(std::span<const Vec3d> points, std::span<const Vec3d> normals,
                             std::span<const double> curvatures, int bins, const Progress& progress,
                             const PairCounter& counter) {
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
  const std::vector<Vec3d> unit = unit_vectors(normals);
  const std::vector<std::int32_t> local = local_codes(points, unit, curvatures, bins);
  ShapeHistogram histogram = histogram_of(points, unit, local, bins * bins, bins, progress, counter);
  histogram.features = PairFeatures::ahd;
  return histogram;
}

}  // namespace astrolith
