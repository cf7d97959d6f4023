#include "estimation/shape/fit/sphere_growth.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <numeric>

#include "estimation/shape/model/model_evaluation_internal.h"
#include "estimation/shape/model/point_clusters.h"
#include "numerics/parallel_for.h"

namespace astrolith {
namespace {

constexpr std::size_t kPointsPerCluster = 32;

// Kernel sum at the surface is 1; a new sphere adds this much there, or to what that is divided by. That
// makes a bump, or a dent, far larger than the error it is to mend, which the first steps of the refinement
// take back; with a smaller share the sphere lies so deep that it is hardly told from others, and stays idle.
constexpr double kStartShare = 0.3;

// A sphere that holds this share of its kind's sum somewhere inside, or outside where it takes away, is not
// idle.
constexpr double kHoldingShare = 0.02;

// A new Gaussian's bump falls by e at this many patches along the surface, whatever the sharpness: with the
// patch as the sphere's radius bumps of soft blends were twice as wide as what they were to mend.
constexpr double kBumpWidth = 0.7;

// Means over a patch, s positive inside the model.
struct PatchError {
  double square = 0.0;  // of s^2
  double mean = 0.0;    // of s
};

// Of the samples within `radius` of sample i.  (#points)
std::vector<PatchError> patch_errors(const std::vector<Vec3d>& points, const std::vector<double>& distances,
                                     double radius) {
  std::vector<PatchError> errors(points.size());
  const std::vector<PointCluster> clusters = cluster_points(points, kPointsPerCluster);
  parallel_for(0, static_cast<std::int64_t>(clusters.size()), [&](std::int64_t c) {
    const PointCluster& own = clusters[static_cast<std::size_t>(c)];
    std::vector<std::size_t> near;
    for (const PointCluster& other : clusters) {
      if (norm(own.center - other.center) > own.radius + other.radius + radius) continue;
      for (const std::int32_t i : other.points) near.push_back(static_cast<std::size_t>(i));
    }
    for (const std::int32_t i : own.points) {
      PatchError sum;
      int count = 0;
      for (const std::size_t j : near) {
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

// How far the surface near a point would move without a sphere.
struct Movement {
  std::int32_t sphere;
  double distance;
};

// Without each of those that hold more than next to nothing there, at every point.  (#points)
std::vector<std::vector<Movement>> movements(const MetaballModel& model, const std::vector<Vec3d>& points) {
  constexpr double kMostOfIt = 0.999, kNextToNothing = 1e-6;
  const ModelEvaluation parameters = evaluation_parameters(model);
  std::vector<std::vector<Movement>> moved(points.size());
  for_each_with_neighbours(model, points, [&](std::size_t p, const std::vector<std::int32_t>& neighbours) {
    std::vector<double> shares;
    const MetaballSums<double> sums =
        totals_with_shares(model, parameters, neighbours, points[p], shares).net();
    const Vec3d slope = metaball_distance(parameters, sums).log_gradient;
    const double slope_length = std::sqrt(squared_norm(slope) + parameters.gradient_floor);
    for (std::size_t j = 0; j < neighbours.size(); ++j) {
      if (shares[j] <= kNextToNothing) continue;
      moved[p].push_back(
          {neighbours[j], level_lost(model, sums.kernel, std::min(shares[j], kMostOfIt)) / slope_length});
    }
  });
  return moved;
}

// Squares of these distances, summed over the points.  (#spheres)
std::vector<double> usefulness(const MetaballModel& model, const std::vector<Vec3d>& points) {
  std::vector<double> use(model.spheres.size(), 0.0);
  for (const std::vector<Movement>& list : movements(model, points)) {
    for (const Movement& m : list) use[static_cast<std::size_t>(m.sphere)] += m.distance * m.distance;
  }
  return use;
}

// Marks the spheres of one kind that hold `share` of its sum at one of the points.
void mark_holding(const MetaballModel& model, bool subtractive, const std::vector<Vec3d>& points,
                  double share, std::vector<bool>& marks) {
  const ModelEvaluation parameters = evaluation_parameters(model);
  std::vector<std::vector<std::int32_t>> holding(points.size());  // a list a point, merged afterwards
  for_each_with_neighbours(model, points, [&](std::size_t p, const std::vector<std::int32_t>& neighbours) {
    std::vector<double> shares;
    totals_with_shares(model, parameters, neighbours, points[p], shares);
    for (std::size_t j = 0; j < neighbours.size(); ++j) {
      const bool of_kind = model.spheres[static_cast<std::size_t>(neighbours[j])].subtractive == subtractive;
      if (of_kind && shares[j] >= share) holding[p].push_back(neighbours[j]);
    }
  });
  for (const auto& list : holding) {
    for (const std::int32_t i : list) marks[static_cast<std::size_t>(i)] = true;
  }
}

// Radius of a new sphere. Along the surface a Gaussian falls as exp(-kappa x^2 / r^2).
double radius_for_patch(const MetaballModel& model, double patch) {
  return model.kernel == Kernel::kGaussian ? kBumpWidth * patch * std::sqrt(model.sharpness) : patch;
}

// How many radii from its centre a kernel has fallen to `value` < 1: bisection, for it falls all the way.
double radii_at_kernel(const MetaballModel& model, double value) {
  const MetaballParameters<double> parameters = evaluation_parameters(model);
  double near = 1.0, far = parameters.cutoff_squared;
  for (int i = 0; i < 60; ++i) {
    const double middle = 0.5 * (near + far);
    (kernel_power(parameters, middle).value > value ? near : far) = middle;
  }
  return std::sqrt(near);
}

// Returns how many spheres went; none, should all that add be unwanted.
int keep_only(MetaballModel& model, const std::vector<bool>& wanted) {
  std::vector<ModelSphere> kept;
  for (std::size_t i = 0; i < model.spheres.size(); ++i) {
    if (wanted[i]) kept.push_back(model.spheres[i]);
  }
  const auto adds = [](const ModelSphere& s) { return !s.subtractive; };
  if (std::none_of(kept.begin(), kept.end(), adds)) return 0;
  const auto removed = static_cast<int>(model.spheres.size() - kept.size());
  model.spheres = std::move(kept);
  return removed;
}

}  // namespace

std::vector<double> model_levels(const MetaballModel& model, const std::vector<Vec3d>& points) {
  std::vector<double> levels(points.size());
  const ModelEvaluation parameters = evaluation_parameters(model);
  for_each_with_neighbours(model, points, [&](std::size_t p, const std::vector<std::int32_t>& neighbours) {
    levels[p] = level_of(model, net_sums_at(model, parameters, neighbours, points[p]).kernel);
  });
  return levels;
}

std::vector<double> model_distances(const MetaballModel& model, std::span<const Vec3d> points) {
  const std::vector<Vec3d> all(points.begin(), points.end());
  std::vector<double> distances(all.size());
  const ModelEvaluation parameters = evaluation_parameters(model);
  for_each_with_neighbours(model, all, [&](std::size_t p, const std::vector<std::int32_t>& neighbours) {
    distances[p] = metaball_distance(parameters, net_sums_at(model, parameters, neighbours, all[p])).distance;
  });
  return distances;
}

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
  std::vector<Vec3d> occupied;
  int num_subtractive = 0;
  for (const std::size_t i : order) {
    if (grown.size() >= static_cast<std::size_t>(options.count)) break;
    const Vec3d& p = samples.points[i];
    const bool free = std::none_of(occupied.begin(), occupied.end(),
                                   [&](const Vec3d& q) { return squared_norm(p - q) < 4.0 * patch * patch; });
    if (!free) continue;
    occupied.push_back(p);
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
