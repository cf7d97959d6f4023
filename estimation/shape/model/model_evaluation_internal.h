// A metaball model evaluated at many points. Points that lie close together form a cluster and share one list
// of spheres. Clusters that follow one another form a group: the spheres that reach the group are found
// first, and each cluster of the group looks only among these.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "estimation/shape/model/block_kernels.h"
#include "estimation/shape/model/metaball_model.h"
#include "numerics/parallel_for.h"
#include "numerics/vec3.h"

namespace astrolith {

struct PointCluster {
  std::vector<std::int32_t> points;  // indices
  Vec3d center;                      // centre of a ball that holds them
  double radius = 0.0;               // radius of this ball
};

// Splits the points along the longest side of their bounding box until no cluster has more than `size` > 0
// points. Their number is the least, #points / size rounded up, and clusters differ by a point or two.
// Clusters that follow one another lie close together. The result depends on the points only.
std::vector<PointCluster> cluster_points(std::span<const Vec3d> points, std::size_t size);

// Some clusters that follow one another, and a ball that holds their points.
struct ClusterGroup {
  std::size_t begin, end;
  Vec3d center;
  double radius;
};

// Groups of up to `size` > 0 clusters each, in order.
std::vector<ClusterGroup> group_clusters(std::span<const PointCluster> clusters, std::size_t size);

// Sets `found` to the indices, ascending, of the spheres whose supports reach a ball. `reach` is the support
// as a multiple of the radius.
void find_spheres(const MetaballModel& model, double reach, const Vec3d& center, double radius,
                  std::vector<std::int32_t>& found);
// Looks only among some of the spheres, given by their indices, ascending.
void find_spheres(const MetaballModel& model, double reach, const Vec3d& center, double radius,
                  std::span<const std::int32_t> among, std::vector<std::int32_t>& found);

// What one thread needs to evaluate clusters one after another.
struct ClusterScratch {
  std::vector<std::int32_t> group_spheres,
      spheres;  // indices, ascending: that reach the group, and the cluster
  std::vector<Vec3d> points;
  BlockKernels kernels;
};

// Calls visit(cluster's index, scratch) for all clusters, in parallel. scratch.spheres holds the spheres
// whose supports may reach the cluster.
template <typename Visit>
void for_each_cluster(const MetaballModel& model, std::span<const PointCluster> clusters,
                      std::span<const ClusterGroup> groups, double reach, const Visit& visit) {
  parallel_for(0, static_cast<std::int64_t>(groups.size()), [&](std::int64_t g) {
    const ClusterGroup& group = groups[static_cast<std::size_t>(g)];
    ClusterScratch scratch;
    find_spheres(model, reach, group.center, group.radius, scratch.group_spheres);
    for (std::size_t c = group.begin; c < group.end; ++c) {
      find_spheres(model, reach, clusters[c].center, clusters[c].radius, scratch.group_spheres,
                   scratch.spheres);
      visit(c, scratch);
    }
  });
}

// How many clusters a group has in the evaluations of a model.
inline constexpr std::size_t kClustersPerGroup = 16;

// Evaluates the kernels at all points, in parallel. Calls visit(indices of some points, scratch) for every
// cluster of them: number j of scratch.kernels is point j of the list.
template <typename Visit>
void for_each_block(const MetaballModel& model, std::span<const Vec3d> points, const Visit& visit) {
  const ModelEvaluation evaluation = evaluation_parameters(model);
  const std::vector<PointCluster> clusters = cluster_points(points, BlockKernels::kMostPoints);
  for_each_cluster(model, clusters, group_clusters(clusters, kClustersPerGroup), support_radii(model),
                   [&](std::size_t c, ClusterScratch& scratch) {
                     scratch.points.clear();
                     for (const std::int32_t i : clusters[c].points) {
                       scratch.points.push_back(points[static_cast<std::size_t>(i)]);
                     }
                     scratch.kernels.evaluate(model, evaluation, scratch.spheres, scratch.points);
                     visit(clusters[c].points, scratch);
                   });
}

}  // namespace astrolith
