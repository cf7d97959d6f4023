#include "estimation/shape/model/model_levels.h"

#include "estimation/shape/model/model_evaluation_internal.h"

namespace astrolith {

std::vector<double> model_levels(const MetaballModel& model, std::span<const Vec3d> points) {
  std::vector<double> levels(points.size());
  for_each_block(model, points, [&](std::span<const std::int32_t> own, const ClusterScratch& scratch) {
    for (std::size_t j = 0; j < own.size(); ++j) {
      levels[static_cast<std::size_t>(own[j])] = level_of(model, scratch.kernels.totals(j).net().kernel);
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

}  // namespace astrolith
