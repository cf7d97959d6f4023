#include "estimation/shape/details/details_fit.h"

#include <algorithm>
#include <cmath>

#include "numerics/errors.h"
#include "numerics/parallel_for.h"
#include "recipe/recipe_json.h"
#include "synthesis/field/field_mesh.h"
#include "synthesis/field/implicit_field.h"

namespace astrolith {
namespace {

TriangleMesh mesh_in_target_frame(const TargetBody& target, const Recipe& recipe, int resolution) {
  const ImplicitField field(recipe);
  MeshCollector collector;
  mesh_field(field, field.bounds(), resolution, collector);
  for (Vec3d& p : collector.mesh.vertices) p = (p - target.center) * (1.0 / target.diagonal);
  return std::move(collector.mesh);
}

void check(const DetailsFitOptions& options) {
  if (options.population < 1 || options.generations < 1) {
    throw InputError("population and generations: give at least 1");
  }
}

struct Start {
  PlainNoise noise;
  std::vector<double> parameters;
  DetailScore score;
};

// Facets reduce the amplitude, which the closed form does not include. The amplitude is raised by the factor
// that is missing on the mesh.
void correct_amplitude(const DetailFitness& fitness, PlainNoise& noise) {
  const std::vector<double> reached =
      fitness.layers_roughness(detail_layers(detail_parameters(noise, fitness.ranges()), fitness.ranges()));
  double sum = 0.0;
  for (std::size_t k = 0; k < reached.size(); ++k) {
    sum += std::log(std::max(fitness.target_roughness()[k], 1e-30) / std::max(reached[k], 1e-30));
  }
  const double factor = std::exp(sum / static_cast<double>(reached.size()));
  noise.amplitude = std::clamp(factor * noise.amplitude, fitness.ranges().least_amplitude,
                               fitness.ranges().largest_amplitude);
}

// The plain noise with the best fitness among those that are as rough as the target.
Start best_plain_noise(const DetailFitness& fitness) {
  const RoughnessModel model;
  Start best;
  for (std::size_t which = 0; which < 3; ++which) {
    for (PlainNoise noise :
         noises_as_rough_as(fitness.target_roughness(), fitness.lags(), which, fitness.ranges(), model)) {
      correct_amplitude(fitness, noise);
      const std::vector<double> parameters = detail_parameters(noise, fitness.ranges());
      const DetailScore score = fitness.score(detail_layers(parameters, fitness.ranges()));
      if (best.parameters.empty() || score.fitness() < best.score.fitness())
        best = {noise, parameters, score};
    }
  }
  return best;
}

// Computes the scores in two halves if the evaluator's memory is too small for all candidates.
std::vector<DetailScore> find_scores(const DetailFitness& fitness,
                                     std::span<const std::vector<FractalLayer>> candidates,
                                     CandidateEvaluator& evaluator) {
  try {
    return fitness.scores(candidates, evaluator);
  } catch (const OutOfDeviceMemory&) {
    if (candidates.size() < 2) throw;
  }
  const std::size_t half = candidates.size() / 2;
  std::vector<DetailScore> scores = find_scores(fitness, candidates.first(half), evaluator);
  for (const DetailScore& score : find_scores(fitness, candidates.subspan(half), evaluator))
    scores.push_back(score);
  return scores;
}

std::vector<double> evaluate_fitness(const DetailFitness& fitness,
                                     std::span<const std::vector<double>> points,
                                     CandidateEvaluator* evaluator) {
  std::vector<std::vector<FractalLayer>> candidates;
  for (const std::vector<double>& x : points) candidates.push_back(detail_layers(x, fitness.ranges()));
  std::vector<double> values(points.size());
  if (evaluator != nullptr) {
    const std::vector<DetailScore> scores = find_scores(fitness, candidates, *evaluator);
    for (std::size_t i = 0; i < values.size(); ++i) values[i] = scores[i].fitness();
    return values;
  }
  parallel_for(0, static_cast<std::int64_t>(values.size()), [&](std::int64_t i) {
    const auto k = static_cast<std::size_t>(i);
    values[k] = fitness.score(candidates[k]).fitness();
  });
  return values;
}

Vec3d rounded(const Vec3d& v) {
  return {round_to_seven_digits(v.x), round_to_seven_digits(v.y), round_to_seven_digits(v.z)};
}

}  // namespace

FitCheck check_recipe(const TargetBody& target, const Recipe& recipe, int resolution, std::int64_t samples,
                      std::uint64_t seed) {
  return check_mesh(target, mesh_in_target_frame(target, recipe, resolution), samples, seed);
}

DetailsFitResult fit_details(const TargetBody& target, const MetaballBody& base,
                             const DetailsFitOptions& options, const Progress& progress) {
  check(options);
  const DetailFitness fitness(target, base, options.fitness);
  const Start start = best_plain_noise(fitness);
  OptimizeOptions optimize;
  optimize.algorithm = options.optimizer;
  optimize.population = options.population;
  optimize.max_evaluations = std::int64_t{options.population} * options.generations;
  optimize.seed = options.seed;
  optimize.start = start.parameters;
  const BatchObjective objective = [&](std::span<const std::vector<double>> points) {
    return evaluate_fitness(fitness, points, options.evaluator);
  };
  EvaluationLog own_log;
  const BatchObjective remembered = logged(objective, options.log != nullptr ? *options.log : own_log);

  DetailsFitResult result;
  result.start = start.noise;
  result.ranges = fitness.ranges();
  result.start_score = start.score;
  result.base_score = fitness.score({});
  result.optimization = minimize(remembered, detail_bounds(fitness.ranges()), optimize, progress);
  result.interrupted = result.optimization.stopped;
  if (result.optimization.value < result.base_score.fitness()) {
    result.layers = detail_layers(result.optimization.x, fitness.ranges());
  }
  result.score = fitness.score(result.layers);
  result.lags = fitness.lags();
  result.target_roughness = fitness.target_roughness();
  result.roughness = fitness.layers_roughness(result.layers);
  return result;
}

// With p_file = center + diagonal p, the argument f (scale p + bias) of the noise stays the same.
std::vector<FractalLayer> layers_in_file_frame(std::vector<FractalLayer> layers, const TargetBody& target) {
  const double d = target.diagonal;
  const Vec3d& c = target.center;
  for (FractalLayer& layer : layers) {
    const Vec3d& s = layer.scale;
    layer.bias = rounded(d * layer.bias - Vec3d{s.x * c.x, s.y * c.y, s.z * c.z});
    layer.scale = rounded(s);
    layer.amplitude = round_to_seven_digits(d * layer.amplitude);
    layer.frequency = round_to_seven_digits(layer.frequency / d);
    layer.gain = round_to_seven_digits(layer.gain);
    layer.weight = round_to_seven_digits(layer.weight);
    layer.gradient_modulation = round_to_seven_digits(layer.gradient_modulation);
  }
  return layers;
}

}  // namespace astrolith
