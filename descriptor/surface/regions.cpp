#include "descriptor/surface/regions.h"

#include <algorithm>
#include <limits>
#include <numeric>

#include "geometry/surface/mesh_sampling.h"
#include "numerics/parallel_for.h"

namespace astrolith {
namespace {

using LagSums = std::array<PairSum, kCovarianceLags.size()>;

std::vector<double> deviations(std::span<const double> values) {
  double mean = 0.0;
  for (const double v : values) mean += v / static_cast<double>(values.size());
  std::vector<double> from_mean(values.begin(), values.end());
  for (double& v : from_mean) v -= mean;
  return from_mean;
}

double mean_square(std::span<const double> values) {
  double sum = 0.0;
  for (const double v : values) sum += v * v;
  return values.empty() ? 0.0 : sum / static_cast<double>(values.size());
}

// The pairs that place i forms with the later places of its region.
LagSums lag_sums(std::size_t i, std::span<const std::uint8_t> regions, std::span<const Vec3d> places,
                 std::span<const double> values, double edge) {
  LagSums sums{};
  for (std::size_t j = i + 1; j < places.size(); ++j) {
    if (regions[j] != regions[i]) continue;
    const double squared = squared_norm(places[j] - places[i]) / (edge * edge);
    for (std::size_t lag = 0; lag < sums.size(); ++lag) {
      const auto [low, high] = kCovarianceLags[lag];
      if (squared < low * low || squared >= high * high) continue;
      sums[lag].products += values[i] * values[j];
      sums[lag].pairs += 1.0;
    }
  }
  return sums;
}

double mean_variance(std::span<const std::uint8_t> region_index, std::span<const double> values) {
  std::array<double, kRegions> sums{}, counts{};
  for (std::size_t i = 0; i < values.size(); ++i) {
    sums[region_index[i]] += values[i];
    counts[region_index[i]] += 1.0;
  }
  std::vector<double> means;
  for (std::size_t r = 0; r < kRegions; ++r) {
    if (counts[r] > 0.0) means.push_back(sums[r] / counts[r]);
  }
  return mean_square(deviations(means));
}

using Centers = std::array<Vec3d, kRegions>;

// Numbers the groups of the regions from `first` on; there are `groups` of them, a power of 2.
void halve(std::span<std::uint8_t> regions, const Centers& centers, int groups, int first,
           RegionGroups& region_group) {
  if (groups == 1) {
    for (const std::uint8_t r : regions) region_group[r] = static_cast<std::uint8_t>(first);
    return;
  }
  Box box;
  for (const std::uint8_t r : regions) box.extend(centers[r]);
  double Vec3d::*const axis = longest_axis(box.extent());
  std::stable_sort(regions.begin(), regions.end(),
                   [&](std::uint8_t a, std::uint8_t b) { return centers[a].*axis < centers[b].*axis; });
  const std::size_t half = regions.size() / 2;
  halve(regions.first(half), centers, groups / 2, first, region_group);
  halve(regions.subspan(half), centers, groups / 2, first + groups / 2, region_group);
}

}  // namespace

RegionGroups region_groups(std::span<const std::uint8_t> region_index, std::span<const Vec3d> places) {
  Centers centers{};
  std::array<double, kRegions> counts{};
  for (std::size_t i = 0; i < places.size(); ++i) {
    centers[region_index[i]] += places[i];
    counts[region_index[i]] += 1.0;
  }
  for (std::size_t r = 0; r < kRegions; ++r) {
    if (counts[r] > 0.0) centers[r] *= 1.0 / counts[r];
  }
  RegionGroups regions{}, region_group{};
  std::iota(regions.begin(), regions.end(), std::uint8_t{0});
  halve(regions, centers, kRegionGroups, 0, region_group);
  return region_group;
}

double Regions::correlation(std::size_t lag) const {
  PairSum all;
  for (const auto& region : pairs) {
    all.products += region[lag].products;
    all.pairs += region[lag].pairs;
  }
  return all.pairs > 0.0 && variance > 0.0 ? all.products / all.pairs / variance : 0.0;
}

std::vector<std::uint8_t> find_regions(const TriangleMesh& mesh, std::span<const Vec3d> places,
                                       std::uint64_t seed) {
  const std::vector<Vec3d> centers = sample_poisson_disk(mesh, kRegions, seed).points;
  std::vector<std::uint8_t> regions;
  regions.reserve(places.size());
  for (const Vec3d& place : places) {
    double nearest = std::numeric_limits<double>::infinity();
    std::size_t region = 0;
    for (std::size_t r = 0; r < centers.size(); ++r) {
      const double squared = squared_norm(centers[r] - place);
      if (squared >= nearest) continue;
      nearest = squared;
      region = r;
    }
    regions.push_back(static_cast<std::uint8_t>(region));
  }
  return regions;
}

Regions regional_sums(std::vector<std::uint8_t> region_index, std::span<const Vec3d> places,
                      std::span<const double> values, double edge) {
  const std::vector<double> from_mean = deviations(values);
  std::vector<LagSums> sums(places.size());
  parallel_for(
      0, static_cast<std::int64_t>(places.size()),
      [&](std::int64_t i) {
        const auto k = static_cast<std::size_t>(i);
        sums[k] = lag_sums(k, region_index, places, from_mean, edge);
      },
      16);
  Regions regions;
  for (std::size_t i = 0; i < places.size(); ++i) {
    for (std::size_t lag = 0; lag < kCovarianceLags.size(); ++lag) {
      PairSum& region = regions.pairs[region_index[i]][lag];
      region.products += sums[i][lag].products;
      region.pairs += sums[i][lag].pairs;
    }
  }
  regions.variance = mean_square(from_mean);
  regions.between = mean_variance(region_index, from_mean);
  regions.groups = region_groups(region_index, places);
  regions.region_index = std::move(region_index);
  return regions;
}

}  // namespace astrolith
