// A metaball model evaluated at many points. Points that lie close together form a cluster and share one list
// of spheres.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "estimation/shape/model/metaball_model.h"
#include "estimation/shape/model/point_clusters.h"
#include "numerics/parallel_for.h"

namespace astrolith {

// Indices, ascending, of the spheres that may reach the cluster. `reach` is their support as a multiple of
// their radii.
inline std::vector<std::int32_t> spheres_within(const MetaballModel& model, const PointCluster& cluster,
                                                double reach) {
  std::vector<std::int32_t> found;
  for (std::size_t i = 0; i < model.spheres.size(); ++i) {
    const Sphere& s = model.spheres[i];
    const double distance = cluster.radius + reach * s.radius;
    if (squared_norm(s.center - cluster.center) < distance * distance) {
      found.push_back(static_cast<std::int32_t>(i));
    }
  }
  return found;
}

// Calls visit(point index, indices of the spheres whose support may reach it) for all points, in parallel.
template <typename Visit>
void for_each_with_neighbours(const MetaballModel& model, const std::vector<Vec3d>& points,
                              const Visit& visit) {
  constexpr std::size_t kPointsPerCluster = 32;
  const double cutoff = support_radii(model);
  const std::vector<PointCluster> clusters = cluster_points(points, kPointsPerCluster);
  parallel_for(0, static_cast<std::int64_t>(clusters.size()), [&](std::int64_t c) {
    const PointCluster& cluster = clusters[static_cast<std::size_t>(c)];
    const std::vector<std::int32_t> neighbours = spheres_within(model, cluster, cutoff);
    for (const std::int32_t i : cluster.points) visit(static_cast<std::size_t>(i), neighbours);
  });
}

inline void add_sums(const MetaballSums<double>& more, MetaballSums<double>& sums) {
  sums.kernel += more.kernel;
  sums.weighted += more.weighted;
}

// Returns the sums at a point over some of the model's spheres. `shares` receives the share of each sphere in
// the sum of its kind: k / P for an additive metaball, k / (1 + N) for a subtractive one.
inline MetaballTotals<double> totals_with_shares(const MetaballModel& model,
                                                 const ModelEvaluation& evaluation,
                                                 std::span<const std::int32_t> spheres, const Vec3d& p,
                                                 std::vector<double>& shares) {
  MetaballTotals<double> totals;
  shares.resize(spheres.size());
  for (std::size_t j = 0; j < spheres.size(); ++j) {
    MetaballTotals<double> own;
    accumulate_metaball(evaluation, kernel_of(model.spheres[static_cast<std::size_t>(spheres[j])]), p, own);
    shares[j] = own.added.kernel + own.subtracted.kernel;
    add_sums(own.added, totals.added);
    add_sums(own.subtracted, totals.subtracted);
  }
  const double added = totals.added.kernel + double{kKernelFloor},
               subtracted = 1.0 + totals.subtracted.kernel;
  for (std::size_t j = 0; j < spheres.size(); ++j) {
    shares[j] /= model.spheres[static_cast<std::size_t>(spheres[j])].subtractive ? subtracted : added;
  }
  return totals;
}

// The net sums at a point over some of the model's spheres.
inline MetaballSums<double> net_sums_at(const MetaballModel& model, const ModelEvaluation& evaluation,
                                        std::span<const std::int32_t> spheres, const Vec3d& p) {
  MetaballTotals<double> totals;
  for (const std::int32_t i : spheres) {
    accumulate_metaball(evaluation, kernel_of(model.spheres[static_cast<std::size_t>(i)]), p, totals);
  }
  return totals.net();
}

}  // namespace astrolith
