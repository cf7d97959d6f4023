#include "descriptor/shape_distribution.h"

#include <algorithm>
#include <cmath>
#include <string>

#include "numerics/errors.h"
#include "numerics/parallel_for.h"

namespace astrolith {
namespace {

constexpr std::int64_t kRowsPerChunk = 64;
constexpr std::size_t kMostDistancePoints = std::size_t{1} << 24;
constexpr int kMostDistanceBins = 65536;

void check(std::span<const Vec3d> points, int bins) {
  if (points.size() < 2 || points.size() > kMostDistancePoints) {
    throw InputError("shape distribution: " + std::to_string(points.size()) + " points; give between 2 and " +
                     std::to_string(kMostDistancePoints));
  }
  if (bins < 1 || bins > kMostDistanceBins) {
    throw InputError("shape distribution: " + std::to_string(bins) + " bins; give between 1 and " +
                     std::to_string(kMostDistanceBins));
  }
  for (const Vec3d& p : points) {
    if (!std::isfinite(squared_norm(p))) throw InputError("shape distribution: a point is not finite");
  }
}

// The mean distance of all pairs. Sums of rows are added in the order of the rows, so that the mean has the
// same bits for any number of threads.
double mean_distance(std::span<const Vec3d> points, double pairs) {
  std::vector<double> rows(points.size(), 0.0);
  parallel_for(
      0, static_cast<std::int64_t>(points.size()),
      [&](std::int64_t index) {
        const auto i = static_cast<std::size_t>(index);
        double sum = 0;
        for (std::size_t j = 0; j < i; ++j) sum += norm(points[j] - points[i]);
        rows[i] = sum;
      },
      kRowsPerChunk);
  double total = 0;
  for (const double sum : rows) total += sum;
  return total / pairs;
}

std::vector<std::uint64_t> count_rows(std::span<const Vec3d> points, std::size_t first, std::size_t last,
                                      double bins_per_unit, int bins) {
  std::vector<std::uint64_t> counts(static_cast<std::size_t>(bins), 0);
  const double last_bin = bins - 1;
  for (std::size_t i = first; i < last; ++i) {
    for (std::size_t j = 0; j < i; ++j) {
      const double bin = std::min(bins_per_unit * norm(points[j] - points[i]), last_bin);
      ++counts[static_cast<std::size_t>(bin)];
    }
  }
  return counts;
}

}  // namespace

std::vector<double> ShapeDistribution::frequencies() const {
  std::vector<double> f(counts.begin(), counts.end());
  for (double& value : f) value /= static_cast<double>(std::max<std::uint64_t>(pairs, 1));
  return f;
}

ShapeDistribution shape_distribution(std::span<const Vec3d> points, int bins) {
  check(points, bins);
  const std::uint64_t n = points.size();
  ShapeDistribution d{std::vector<std::uint64_t>(static_cast<std::size_t>(bins), 0), n * (n - 1) / 2, 0.0};
  d.mean_distance = mean_distance(points, static_cast<double>(d.pairs));
  if (!(d.mean_distance > 0)) {
    throw InputError("shape distribution: all points are in one place; give points of a surface");
  }
  const double bins_per_unit = bins / (kDistributionReach * d.mean_distance);
  const auto chunks = static_cast<std::int64_t>((n + kRowsPerChunk - 1) / kRowsPerChunk);
  std::vector<std::vector<std::uint64_t>> counts(static_cast<std::size_t>(chunks));
  parallel_for(0, chunks, [&](std::int64_t chunk) {
    const auto first = static_cast<std::size_t>(chunk * kRowsPerChunk);
    const std::size_t last = std::min<std::size_t>(first + kRowsPerChunk, points.size());
    counts[static_cast<std::size_t>(chunk)] = count_rows(points, first, last, bins_per_unit, bins);
  });
  for (const auto& chunk_counts : counts) {
    for (std::size_t b = 0; b < d.counts.size(); ++b) d.counts[b] += chunk_counts[b];
  }
  return d;
}

}  // namespace astrolith
