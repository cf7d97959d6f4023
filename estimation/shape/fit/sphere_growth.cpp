#include "estimation/shape/fit/sphere_growth.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <numbers>
#include <numeric>

#include "estimation/shape/model/metaball_model.h"
#include "estimation/shape/model/model_evaluation_internal.h"
#include "numerics/parallel_for.h"

namespace astrolith {
namespace {

constexpr std::size_t kPointsPerCluster = 32;

// The sum of kernels is 1 at the surface. A new additive metaball adds this much to it, and a new subtractive
// one adds this much to the sum that divides it. The bump or dent is far larger than the error to be
// corrected, and the first steps of the refinement reduce it. With a smaller share the metaball would lie so
// deep that the refinement could not tell it from others, and it would stay idle.
constexpr double kStartShare = 0.3;

// A metaball that holds this share of its kind's sum at a containment point is not idle.
constexpr double kHoldingShare = 0.02;

// Along the surface the bump of a new Gaussian falls by the factor e at this many patch radii, for every
// sharpness. With the patch radius as the metaball's radius, bumps of soft blends were twice as wide as the
// error.
constexpr double kBumpWidth = 0.7;

// Means over a patch. The distance s is positive inside the model.
struct PatchError {
  double square = 0.0;  // mean of s^2
  double mean = 0.0;    // mean of s
};

// The errors of the patches around every point. A patch holds the points within `radius`.  (#points)
std::vector<PatchError> patch_errors(const std::vector<Vec3d>& points, const std::vector<double>& distances,
                                     double radius) {
  std::vector<PatchError> errors(points.size());
  const std::vector<PointCluster> clusters = cluster_points(points, kPointsPerCluster);
  const std::vector<ClusterGroup> groups = group_clusters(clusters, kClustersPerGroup);
  parallel_for(0, static_cast<std::int64_t>(clusters.size()), [&](std::int64_t c) {
    const PointCluster& own = clusters[static_cast<std::size_t>(c)];
    const auto reaches = [&](const Vec3d& center, double other_radius) {
      return norm(own.center - center) <= own.radius + other_radius + radius;
    };
    std::vector<std::size_t> in_reach;
    for (const ClusterGroup& group : groups) {
      if (!reaches(group.center, group.radius)) continue;
      for (std::size_t k = group.begin; k < group.end; ++k) {
        if (!reaches(clusters[k].center, clusters[k].radius)) continue;
        for (const std::int32_t i : clusters[k].points) in_reach.push_back(static_cast<std::size_t>(i));
      }
    }
    for (const std::int32_t i : own.points) {
      PatchError sum;
      int count = 0;
      for (const std::size_t j : in_reach) {
        if (squared_norm(points[j] - points[static_cast<std::size_t>(i)]) > radius * radius) continue;
        sum.square += distances[j] * distances[j];
        sum.mean += distances[j];
        ++count;
      }
      errors[static_cast<std::size_t>(i)] = {sum.square / count, sum.mean / count};
    }
  });
  return errors;
}

// Places of which no two lie closer together than a given distance.
class SpacedPlaces {
 public:
  explicit SpacedPlaces(double spacing) : spacing_(spacing) {}

  // Takes the place if no other is too close. Returns whether it was taken.
  bool take(const Vec3d& p) {
    const Cell cell = cell_at(p);
    for (std::int64_t x = cell[0] - 1; x <= cell[0] + 1; ++x) {
      for (std::int64_t y = cell[1] - 1; y <= cell[1] + 1; ++y) {
        for (std::int64_t z = cell[2] - 1; z <= cell[2] + 1; ++z) {
          const auto found = cells_.find({x, y, z});
          if (found != cells_.end() && too_close(p, found->second)) return false;
        }
      }
    }
    cells_[cell].push_back(p);
    return true;
  }

 private:
  using Cell = std::array<std::int64_t, 3>;

  Cell cell_at(const Vec3d& p) const {
    const auto along = [&](double x) { return static_cast<std::int64_t>(std::floor(x / spacing_)); };
    return {along(p.x), along(p.y), along(p.z)};
  }
  bool too_close(const Vec3d& p, const std::vector<Vec3d>& places) const {
    return std::any_of(places.begin(), places.end(),
                       [&](const Vec3d& q) { return squared_norm(p - q) < spacing_ * spacing_; });
  }

  double spacing_;
  std::map<Cell, std::vector<Vec3d>> cells_;
};

// How far the surface at a point would move without a sphere.
struct Movement {
  std::int32_t sphere;
  double distance;
};

// For every point the movements without each of the spheres in reach. Spheres with a negligible share of
// their kind's sum are left out.  (#points)
std::vector<std::vector<Movement>> movements(const MetaballModel& model, std::span<const Vec3d> points) {
  constexpr double kLargestShare = 0.999, kNegligibleShare = 1e-6;
  const ModelEvaluation evaluation = evaluation_parameters(model);
  std::vector<std::vector<Movement>> moved(points.size());
  for_each_block(model, points, [&](std::span<const std::int32_t> own, const ClusterScratch& scratch) {
    for (std::size_t j = 0; j < own.size(); ++j) {
      const MetaballSums<double> sums = scratch.kernels.totals(j).net();
      const Vec3d slope = metaball_distance(evaluation, sums).log_gradient;
      const double slope_length = std::sqrt(squared_norm(slope) + evaluation.gradient_floor);
      for (std::size_t i = 0; i < scratch.spheres.size(); ++i) {
        const double share = scratch.kernels.share(i, j);
        if (share <= kNegligibleShare) continue;
        moved[static_cast<std::size_t>(own[j])].push_back(
            {scratch.spheres[i], level_lost(model, std::min(share, kLargestShare)) / slope_length});
      }
    }
  });
  return moved;
}

// For every sphere the sum of its squared movements over all points.  (#spheres)
std::vector<double> usefulness(const MetaballModel& model, std::span<const Vec3d> points) {
  std::vector<double> use(model.spheres.size(), 0.0);
  for (const std::vector<Movement>& list : movements(model, points)) {
    for (const Movement& m : list) use[static_cast<std::size_t>(m.sphere)] += m.distance * m.distance;
  }
  return use;
}

// Marks the spheres of one kind that hold `share` of its sum at one of the points.
void mark_holding(const MetaballModel& model, bool subtractive, std::span<const Vec3d> points, double share,
                  std::vector<bool>& marks) {
  std::vector<std::vector<std::int32_t>> holding(
      points.size());  // one list for the first point of each block
  for_each_block(model, points, [&](std::span<const std::int32_t> own, const ClusterScratch& scratch) {
    std::vector<std::int32_t>& list = holding[static_cast<std::size_t>(own.front())];
    for (std::size_t i = 0; i < scratch.spheres.size(); ++i) {
      const std::int32_t sphere = scratch.spheres[i];
      const bool same_kind = model.spheres[static_cast<std::size_t>(sphere)].subtractive == subtractive;
      if (same_kind && scratch.kernels.largest_share(i) >= share) list.push_back(sphere);
    }
  });
  for (const auto& list : holding) {
    for (const std::int32_t i : list) marks[static_cast<std::size_t>(i)] = true;
  }
}

// The radius of a new metaball for a patch of this radius. Along the surface a Gaussian falls as
// exp(-kappa x^2 / r^2).
double radius_for_patch(const MetaballModel& model, double patch) {
  return kBumpWidth * patch * std::sqrt(model.sharpness);
}

// The distance from the centre, in radii, at which the kernel has the value `value` < 1. The kernel decreases
// monotonically, so bisection finds it.
double radii_at_kernel(const MetaballModel& model, double value) {
  const MetaballParameters<double> parameters = evaluation_parameters(model);
  double low = 1.0, high = parameters.cutoff_squared;  // squared distances
  for (int i = 0; i < 60; ++i) {
    const double middle = 0.5 * (low + high);
    (kernel_power(parameters, middle).value > value ? low : high) = middle;
  }
  return std::sqrt(low);
}

// Removes the unwanted spheres and returns how many. Removes none if no additive one is wanted.
int keep_only(MetaballModel& model, const std::vector<bool>& wanted) {
  std::vector<ModelSphere> kept;
  for (std::size_t i = 0; i < model.spheres.size(); ++i) {
    if (wanted[i]) kept.push_back(model.spheres[i]);
  }
  const auto additive = [](const ModelSphere& s) { return !s.subtractive; };
  if (std::none_of(kept.begin(), kept.end(), additive)) return 0;
  const auto removed = static_cast<int>(model.spheres.size() - kept.size());
  model.spheres = std::move(kept);
  return removed;
}

}  // namespace

std::vector<ModelSphere> spheres_for_largest_errors(const MetaballModel& model, const SurfaceSamples& samples,
                                                    const GrowthOptions& options) {
  const double patch = std::sqrt(options.area / (std::numbers::pi * options.budget));  // radius of a disk
  const std::vector<PatchError> errors =
      patch_errors(samples.points, model_distances(model, samples.points), patch);
  std::vector<std::size_t> order(errors.size());
  std::iota(order.begin(), order.end(), std::size_t{0});
  std::stable_sort(order.begin(), order.end(),
                   [&](std::size_t i, std::size_t j) { return errors[i].square > errors[j].square; });

  const double radius = radius_for_patch(model, patch);
  const double depth = radius * radii_at_kernel(model, kStartShare);
  std::vector<ModelSphere> grown;
  SpacedPlaces occupied(2.0 * patch);
  int num_subtractive = 0;
  for (const std::size_t i : order) {
    if (grown.size() >= static_cast<std::size_t>(options.count)) break;
    const Vec3d& p = samples.points[i];
    if (!occupied.take(p)) continue;
    const bool subtractive = errors[i].mean > 0.0 && num_subtractive < options.subtractive;
    if (subtractive) ++num_subtractive;
    grown.emplace_back(p + samples.normals[i] * (subtractive ? depth : -depth), radius, subtractive);
  }
  return grown;
}

int remove_idle_spheres(MetaballModel& model, const FitPoints& points, double distance) {
  std::vector<bool> busy(model.spheres.size(), false);
  for (const std::vector<Movement>& list : movements(model, points.on_surface)) {
    for (const Movement& m : list) {
      if (m.distance >= distance) busy[static_cast<std::size_t>(m.sphere)] = true;
    }
  }
  mark_holding(model, false, points.inside, kHoldingShare, busy);
  mark_holding(model, true, points.outside, kHoldingShare, busy);
  return keep_only(model, busy);
}

void remove_least_useful_spheres(MetaballModel& model, const std::vector<Vec3d>& on_surface, int count) {
  const std::vector<double> use = usefulness(model, on_surface);
  std::vector<std::size_t> order(use.size());
  std::iota(order.begin(), order.end(), std::size_t{0});
  std::stable_sort(order.begin(), order.end(), [&](std::size_t i, std::size_t j) { return use[i] < use[j]; });
  std::vector<bool> wanted(use.size(), true);
  for (std::size_t k = 0; k < order.size() && k < static_cast<std::size_t>(count); ++k)
    wanted[order[k]] = false;
  keep_only(model, wanted);
}

int remove_outside_spheres(MetaballModel& model, const SurfaceTree& target, double margin) {
  std::vector<bool> inside;
  for (const ModelSphere& s : model.spheres) {
    inside.push_back(s.subtractive || target.signed_distance(s.center) >= -margin);
  }
  return keep_only(model, inside);
}

}  // namespace astrolith
