#include "estimation/shape/model/metaball_model.h"

#include <algorithm>
#include <cmath>
#include <string>

#include "estimation/shape/model/block_kernels.h"
#include "estimation/shape/model/model_evaluation_internal.h"
#include "numerics/errors.h"
#include "recipe/recipe_json.h"

namespace astrolith {
namespace {

class Projector {
 public:
  Projector(const MetaballModel& model, int steps)
      : model_(model),
        evaluation_(evaluation_parameters(model)),
        longest_step_(largest_radius(model)),
        steps_(steps) {}

  // A point moves by up to half the largest radius on its way to the surface.
  double margin() const { return 0.5 * longest_step_; }

  // Projects the points of a block, which the spheres reach.
  void project(std::span<const std::int32_t> spheres, BlockKernels& kernels, std::span<Vec3d> points,
               std::span<Vec3d> normals) const {
    for (std::size_t j = 0; j < points.size(); ++j) normals[j] = nearest_sphere_direction(points[j]);
    for (int step = 0; step <= steps_; ++step) {
      kernels.evaluate(model_, evaluation_, spheres, points);
      for (std::size_t j = 0; j < points.size(); ++j) {
        const SurfaceDistance<double> at = metaball_distance(evaluation_, kernels.totals(j).net());
        // Without a gradient the point stays here, and so does its gradient.
        if (squared_norm(at.log_gradient) == 0.0) continue;
        normals[j] = normalized(-at.log_gradient);
        // The last evaluation only gives the normal.
        if (step < steps_) points[j] += normals[j] * std::clamp(at.distance, -longest_step_, longest_step_);
      }
    }
  }

 private:
  Vec3d nearest_sphere_direction(const Vec3d& p) const {
    Vec3d direction;
    double nearest = 1e300;
    for (const ModelSphere& s : model_.spheres) {
      const double distance = norm(p - s.center) - s.radius;
      if (s.subtractive || distance >= nearest) continue;
      nearest = distance;
      direction = normalized(p - s.center);
    }
    return direction;
  }

  const MetaballModel& model_;
  ModelEvaluation evaluation_;
  double longest_step_;
  int steps_;
};

// Support of a Gaussian, in radii. Beyond it the kernel is at most e^-16, which is lost in the rounding of
// the sum.
double gaussian_support(double sharpness) { return std::sqrt(1.0 + 16.0 / sharpness); }

// The least slope that a level is divided by, times the largest radius.
constexpr double kSlopeFloor = 1e-3;

}  // namespace

SurfaceSamples project_onto_isosurface(const MetaballModel& model, std::span<const Vec3d> points, int steps) {
  SurfaceSamples result;
  result.points.assign(points.begin(), points.end());
  result.normals.resize(points.size());
  const Projector projector(model, steps);
  std::vector<PointCluster> clusters = cluster_points(points, BlockKernels::kMostPoints);
  for (PointCluster& cluster : clusters) cluster.radius += projector.margin();
  for_each_cluster(model, clusters, group_clusters(clusters, 2), support_radii(model),
                   [&](std::size_t c, ClusterScratch& scratch) {
                     const std::vector<std::int32_t>& own = clusters[c].points;
                     std::vector<Vec3d> moved(own.size()), normals(own.size());
                     for (std::size_t j = 0; j < own.size(); ++j) {
                       moved[j] = points[static_cast<std::size_t>(own[j])];
                     }
                     projector.project(scratch.spheres, scratch.kernels, moved, normals);
                     for (std::size_t j = 0; j < own.size(); ++j) {
                       result.points[static_cast<std::size_t>(own[j])] = moved[j];
                       result.normals[static_cast<std::size_t>(own[j])] = normals[j];
                     }
                   });
  return result;
}

std::vector<double> model_levels(const MetaballModel& model, std::span<const Vec3d> points) {
  std::vector<double> levels(points.size());
  for_each_block(model, points, [&](std::span<const std::int32_t> own, const ClusterScratch& scratch) {
    for (std::size_t j = 0; j < own.size(); ++j) {
      levels[static_cast<std::size_t>(own[j])] = model_level(model, scratch.kernels.totals(j).net().kernel);
    }
  });
  return levels;
}

std::vector<double> model_distances(const MetaballModel& model, std::span<const Vec3d> points) {
  std::vector<double> distances(points.size());
  const ModelEvaluation evaluation = evaluation_parameters(model);
  for_each_block(model, points, [&](std::span<const std::int32_t> own, const ClusterScratch& scratch) {
    for (std::size_t j = 0; j < own.size(); ++j) {
      distances[static_cast<std::size_t>(own[j])] =
          metaball_distance(evaluation, scratch.kernels.totals(j).net()).distance;
    }
  });
  return distances;
}

double largest_radius(const MetaballModel& model) {
  double largest = 0.0;
  for (const ModelSphere& s : model.spheres) {
    if (!s.subtractive) largest = std::max(largest, s.radius);
  }
  return largest;
}

ModelEvaluation evaluation_parameters(const MetaballModel& model) {
  ModelEvaluation evaluation;
  const double floor = kSlopeFloor / largest_radius(model), support = gaussian_support(model.sharpness);
  evaluation.gradient_floor = floor * floor;
  evaluation.m_a = evaluation.m_b = model.sharpness;
  evaluation.inverse_m = 1.0 / model.sharpness;
  evaluation.cutoff_squared = support * support;
  return evaluation;
}

double support_radii(const MetaballModel& model) { return gaussian_support(model.sharpness); }

double model_level(const MetaballModel& model, double sum) {
  return std::log(sum + double{kKernelFloor}) / model.sharpness;
}

double level_lost(const MetaballModel& model, double share) { return -std::log1p(-share) / model.sharpness; }

MetaballBody metaball_body(const MetaballModel& model) {
  const auto rounded = round_to_seven_digits;
  MetaballBody body;
  body.blend_exponent = rounded(model.sharpness);
  body.cutoff_radii = rounded(gaussian_support(model.sharpness));
  for (const ModelSphere& s : model.spheres) {
    (s.subtractive ? body.subtract : body.spheres)
        .push_back({{rounded(s.center.x), rounded(s.center.y), rounded(s.center.z)}, rounded(s.radius)});
  }
  return body;
}

MetaballModel to_model(const MetaballBody& body) {
  if (!body.operations.empty()) throw InputError("body: operations: the fit knows metaballs alone");
  if (body.kernel != Kernel::kGaussian) throw InputError("body: kernel: the fit knows the Gaussian alone");
  MetaballModel model{body.blend_exponent * body.a, {body.spheres.begin(), body.spheres.end()}};
  for (const Sphere& s : body.subtract) model.spheres.emplace_back(s, true);
  const double scale = std::sqrt(body.a / body.b);
  for (ModelSphere& s : model.spheres) s.radius *= scale;
  return model;
}

}  // namespace astrolith
