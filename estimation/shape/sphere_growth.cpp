#include "estimation/shape/sphere_growth.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <numeric>

#include "estimation/shape/model_evaluation_internal.h"
#include "estimation/shape/point_clusters.h"
#include "numerics/parallel_for.h"

namespace astrolith {
namespace {

constexpr std::size_t kPointsPerCluster = 32;

// Kernel sum at the surface is 1; a new sphere adds this much there. That makes a bump far larger than the
// error it is to mend, which the first steps of the refinement take back; with a smaller share the sphere
// lies so deep that it is hardly told from others, and stays idle.
constexpr double kStartShare = 0.3;

// A new Gaussian's bump falls by e at this many patches along the surface, whatever the sharpness: with the
// patch as the sphere's radius bumps of soft blends were twice as wide as what they were to mend.
constexpr double kBumpWidth = 0.7;

MetaballSphere<double> kernel_of(const Sphere& s) { return {s.center, 1.0 / (s.radius * s.radius)}; }

// Mean s^2 of the samples within `radius` of sample i.
std::vector<double> patch_errors(const std::vector<Vec3d>& points, const std::vector<double>& distances,
                                 double radius) {
  std::vector<double> errors(points.size());
  const std::vector<PointCluster> clusters = cluster_points(points, kPointsPerCluster);
  parallel_for(0, static_cast<std::int64_t>(clusters.size()), [&](std::int64_t c) {
    const PointCluster& own = clusters[static_cast<std::size_t>(c)];
    std::vector<std::size_t> near;
    for (const PointCluster& other : clusters) {
      if (norm(own.center - other.center) > own.radius + other.radius + radius) continue;
      for (const std::int32_t i : other.points) near.push_back(static_cast<std::size_t>(i));
    }
    for (const std::int32_t i : own.points) {
      double sum = 0.0;
      int count = 0;
      for (const std::size_t j : near) {
        if (squared_norm(points[j] - points[static_cast<std::size_t>(i)]) > radius * radius) continue;
        sum += distances[j] * distances[j];
        ++count;
      }
      errors[static_cast<std::size_t>(i)] = sum / count;
    }
  });
  return errors;
}

// Squared distance by which the surface would move at every point without one sphere, summed over the points.
// (#spheres)
std::vector<double> usefulness(const MetaballModel& model, const std::vector<Vec3d>& points) {
  constexpr double kMostOfIt = 0.999;
  const MetaballParameters<double> parameters = evaluation_parameters(model);
  std::vector<std::vector<std::pair<std::int32_t, double>>> moved(points.size());
  for_each_with_neighbours(model, points, [&](std::size_t p, const std::vector<std::int32_t>& neighbours) {
    std::vector<double> kernels;
    MetaballSums<double> sums;
    for (const std::int32_t i : neighbours) {
      const double before = sums.kernel;
      accumulate_metaball(parameters, kernel_of(model.spheres[static_cast<std::size_t>(i)]), points[p], sums);
      kernels.push_back(sums.kernel - before);
    }
    const Vec3d slope = metaball_distance(parameters, sums).log_gradient;
    const double slope_length = std::sqrt(squared_norm(slope) + parameters.gradient_floor);
    for (std::size_t j = 0; j < neighbours.size(); ++j) {
      const double share = kernels[j] / (sums.kernel + double{kKernelFloor});
      const double distance = level_lost(model, sums.kernel, std::min(share, kMostOfIt)) / slope_length;
      if (share > 1e-6) moved[p].emplace_back(neighbours[j], distance * distance);
    }
  });
  std::vector<double> use(model.spheres.size(), 0.0);
  for (const auto& list : moved) {
    for (const auto& [i, square] : list) use[static_cast<std::size_t>(i)] += square;
  }
  return use;
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

// Returns how many spheres went; none, should all be unwanted.
int keep_only(MetaballModel& model, const std::vector<bool>& wanted) {
  std::vector<Sphere> kept;
  for (std::size_t i = 0; i < model.spheres.size(); ++i) {
    if (wanted[i]) kept.push_back(model.spheres[i]);
  }
  if (kept.empty()) return 0;
  const auto removed = static_cast<int>(model.spheres.size() - kept.size());
  model.spheres = std::move(kept);
  return removed;
}

}  // namespace

std::vector<double> model_levels(const MetaballModel& model, const std::vector<Vec3d>& points) {
  std::vector<double> levels(points.size());
  const MetaballParameters<double> parameters = evaluation_parameters(model);
  for_each_with_neighbours(model, points, [&](std::size_t p, const std::vector<std::int32_t>& neighbours) {
    MetaballSums<double> sums;
    for (const std::int32_t i : neighbours) {
      accumulate_metaball(parameters, kernel_of(model.spheres[static_cast<std::size_t>(i)]), points[p], sums);
    }
    levels[p] = level_of(model, sums.kernel);
  });
  return levels;
}

std::vector<double> model_distances(const MetaballModel& model, std::span<const Vec3d> points) {
  const std::vector<Vec3d> all(points.begin(), points.end());
  std::vector<double> distances(all.size());
  const MetaballParameters<double> parameters = evaluation_parameters(model);
  for_each_with_neighbours(model, all, [&](std::size_t p, const std::vector<std::int32_t>& neighbours) {
    MetaballSums<double> sums;
    for (const std::int32_t i : neighbours) {
      accumulate_metaball(parameters, kernel_of(model.spheres[static_cast<std::size_t>(i)]), all[p], sums);
    }
    distances[p] = metaball_distance(parameters, sums).distance;
  });
  return distances;
}

std::vector<Sphere> spheres_for_largest_errors(const MetaballModel& model, const SurfaceSamples& samples,
                                               double area, int budget, int count) {
  const double patch =
      std::sqrt(area / (std::numbers::pi * budget));  // radius of a disk of one sphere's area
  const std::vector<double> errors =
      patch_errors(samples.points, model_distances(model, samples.points), patch);
  std::vector<std::size_t> order(errors.size());
  std::iota(order.begin(), order.end(), std::size_t{0});
  std::stable_sort(order.begin(), order.end(),
                   [&](std::size_t i, std::size_t j) { return errors[i] > errors[j]; });

  const double radius = radius_for_patch(model, patch);
  const double depth = radius * radii_at_kernel(model, kStartShare);
  std::vector<Sphere> grown;
  std::vector<Vec3d> taken;
  for (const std::size_t i : order) {
    if (grown.size() >= static_cast<std::size_t>(count)) break;
    const Vec3d& p = samples.points[i];
    const bool free = std::none_of(taken.begin(), taken.end(),
                                   [&](const Vec3d& q) { return squared_norm(p - q) < 4.0 * patch * patch; });
    if (!free) continue;
    taken.push_back(p);
    grown.push_back({p - samples.normals[i] * depth, radius});
  }
  return grown;
}

int remove_idle_spheres(MetaballModel& model, const FitPoints& points, double share) {
  std::vector<Vec3d> all = points.on_surface;
  all.insert(all.end(), points.inside.begin(), points.inside.end());
  const MetaballParameters<double> parameters = evaluation_parameters(model);
  // Which spheres hold their share at a point: a list a point, merged afterwards.
  std::vector<std::vector<std::int32_t>> busy_at(all.size());
  for_each_with_neighbours(model, all, [&](std::size_t p, const std::vector<std::int32_t>& neighbours) {
    std::vector<double> kernels;
    double total = double{kKernelFloor};
    for (const std::int32_t i : neighbours) {
      MetaballSums<double> own;
      accumulate_metaball(parameters, kernel_of(model.spheres[static_cast<std::size_t>(i)]), all[p], own);
      kernels.push_back(own.kernel);
      total += own.kernel;
    }
    for (std::size_t j = 0; j < neighbours.size(); ++j) {
      if (kernels[j] >= share * total) busy_at[p].push_back(neighbours[j]);
    }
  });
  std::vector<bool> busy(model.spheres.size(), false);
  for (const auto& list : busy_at) {
    for (const std::int32_t i : list) busy[static_cast<std::size_t>(i)] = true;
  }
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
  for (const Sphere& s : model.spheres) inside.push_back(target.signed_distance(s.center) >= -margin);
  return keep_only(model, inside);
}

}  // namespace astrolith
