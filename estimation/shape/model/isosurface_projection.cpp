#include "estimation/shape/model/isosurface_projection.h"

#include "estimation/shape/model/point_clusters.h"
#include "numerics/parallel_for.h"

namespace astrolith {
namespace {

constexpr std::size_t kPointsPerCluster = 64;

class Projector {
 public:
  Projector(const MetaballModel& model, int steps)
      : model_(model),
        parameters_(evaluation_parameters(model)),
        cutoff_(support_radii(model)),
        longest_step_(largest_radius(model)),
        steps_(steps) {}

  // Spheres whose support may reach a point of the cluster after the point has moved by up to half the
  // largest radius.
  std::vector<MetaballSphere<double>> neighbours(const PointCluster& cluster) const {
    std::vector<MetaballSphere<double>> found;
    const double reach = cluster.radius + 0.5 * longest_step_;
    for (const ModelSphere& s : model_.spheres) {
      if (norm(s.center - cluster.center) < reach + cutoff_ * s.radius) found.push_back(kernel_of(s));
    }
    return found;
  }

  void project(const std::vector<MetaballSphere<double>>& spheres, Vec3d& point, Vec3d& normal) const {
    normal = nearest_sphere_direction(point);
    for (int step = 0; step <= steps_; ++step) {
      MetaballTotals<double> totals;
      for (const MetaballSphere<double>& s : spheres) accumulate_metaball(parameters_, s, point, totals);
      const SurfaceDistance<double> at = metaball_distance(parameters_, totals.net());
      if (squared_norm(at.log_gradient) == 0.0) return;
      normal = normalized(-at.log_gradient);
      // The last evaluation only gives the normal.
      if (step < steps_) point += normal * std::clamp(at.distance, -longest_step_, longest_step_);
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
  MetaballParameters<double> parameters_;
  double cutoff_;
  double longest_step_;
  int steps_;
};

}  // namespace

SurfaceSamples project_onto_isosurface(const MetaballModel& model, std::span<const Vec3d> points, int steps) {
  SurfaceSamples result;
  result.points.assign(points.begin(), points.end());
  result.normals.resize(points.size());
  const Projector projector(model, steps);
  const std::vector<PointCluster> clusters = cluster_points(result.points, kPointsPerCluster);
  parallel_for(0, static_cast<std::int64_t>(clusters.size()), [&](std::int64_t c) {
    const PointCluster& cluster = clusters[static_cast<std::size_t>(c)];
    const std::vector<MetaballSphere<double>> spheres = projector.neighbours(cluster);
    for (const std::int32_t i : cluster.points) {
      projector.project(spheres, result.points[static_cast<std::size_t>(i)],
                        result.normals[static_cast<std::size_t>(i)]);
    }
  });
  return result;
}

}  // namespace astrolith
