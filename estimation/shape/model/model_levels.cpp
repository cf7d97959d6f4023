#include "estimation/shape/model/model_levels.h"

#include "estimation/shape/model/model_evaluation_internal.h"

namespace astrolith {

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

}  // namespace astrolith
