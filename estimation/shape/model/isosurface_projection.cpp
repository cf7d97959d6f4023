#include "estimation/shape/model/isosurface_projection.h"

#include <algorithm>

#include "estimation/shape/model/block_kernels.h"
#include "estimation/shape/model/model_evaluation_internal.h"

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

}  // namespace astrolith
