#include "tasks/estimation/shape_recipe.h"

#include <algorithm>
#include <cmath>
#include <string>
#include <utility>
#include <variant>
#include <vector>

#include "estimation/shape/details/details_fit.h"
#include "geometry/mesh_measure.h"
#include "numerics/errors.h"
#include "recipe/recipe_json.h"
#include "synthesis/field/field_mesh.h"
#include "synthesis/field/implicit_field.h"
#include "tasks/description/surface_report.h"

namespace astrolith {
namespace {

// Fractions of the bounding-box diagonal, except counts and ratios.
std::vector<std::pair<std::string, double>> achieved(const ShapeFitResult& fit) {
  const SurfaceDistanceReport& d = fit.check.distance;
  std::vector<std::pair<std::string, double>> figures{
      {"max_distance", d.max}, {"mean_distance", d.mean}, {"p99_distance", d.p99}};
  if (fit.similarity) {
    figures.emplace_back("similarity", fit.similarity->value);
    figures.emplace_back("similarity_floor", fit.similarity->floor);
  }
  figures.emplace_back("volume_ratio", fit.check.volume_ratio);
  return figures;
}

nlohmann::ordered_json score_json(const DetailScore& score) {
  return {{"histogram_similarity", score.similarity}, {"roughness_misfit", score.roughness_misfit}};
}

}  // namespace

ShapeFitResult fit_base(const TargetBody& target, const ShapeFitOptions& options, FitCheckpoint& checkpoint,
                        const StageProgress& progress, const std::function<bool()>& interrupted) {
  if (checkpoint.base() != nullptr) {
    ShapeFitResult base = *checkpoint.base();
    measure_fit(target, options, base);
    return base;
  }
  ShapeFitResult fit = fit_shape(target, options, progress);
  if (interrupted()) return fit;
  if (fit.interrupted) {
    measure_fit(target, options, fit);
  } else {
    checkpoint.keep_base(fit);
  }
  return fit;
}

DetailsFitResult add_searched_details(const TargetBody& target, const ShapeFitOptions& options,
                                      int generations, EvaluationLog& log, CandidateEvaluator* evaluator,
                                      const Progress& progress, Recipe& recipe) {
  DetailsFitOptions details;
  details.optimizer = options.optimizer;
  details.population = options.population;
  details.generations = generations;
  details.seed = options.seed;
  details.fitness.seed = options.seed;
  details.fitness.recipe_seed = recipe.seed;
  details.log = &log;
  details.evaluator = evaluator;
  DetailsFitResult result = fit_details(target, in_target_frame(target, *recipe.body), details, progress);
  for (const FractalLayer& layer : layers_in_file_frame(result.layers, target))
    recipe.layers.push_back(layer);
  return result;
}

nlohmann::ordered_json relief_json(const ReliefFit& relief) {
  return {
      {"heights", relief.heights},     {"spacing", relief.layer.spacing},       {"step", relief.layer.step()},
      {"levels", relief.layer.levels}, {"base_distance", relief.base_distance}, {"residual", relief.residual},
      {"left_out", relief.left_out}};
}

void measure_recipe(const TargetBody& target, const Recipe& recipe, const ShapeFitOptions& options,
                    ShapeFitResult& fit) {
  // A mesh with longer edges than the target's would lack what the heights of a relief hold of it.
  constexpr double kMostCells = 2048.0;
  const double cells = target.surface.bounds().longest_side() / mean_edge(target.surface);
  const bool has_relief = std::any_of(recipe.layers.begin(), recipe.layers.end(), [](const Layer& layer) {
    return std::holds_alternative<ReliefLayer>(layer);
  });
  const int resolution =
      has_relief ? std::max(options.check_resolution, static_cast<int>(std::min(cells, kMostCells)))
                 : options.check_resolution;
  fit.check = check_recipe(target, recipe, resolution, options.check_samples, options.seed);
}

void note_achieved(const ShapeFitResult& fit, Recipe& recipe) {
  recipe.provenance.achieved.clear();
  for (auto [name, value] : achieved(fit)) {
    recipe.provenance.achieved.emplace_back(name, round_to_seven_digits(value));
  }
}

nlohmann::ordered_json fit_figures(const ShapeFitResult& fit) {
  nlohmann::ordered_json summary;
  summary["spheres"] = fit.body.num_metaballs();
  summary["subtracting_spheres"] = fit.body.subtract.size();
  for (const auto& [name, value] : achieved(fit)) summary[name] = value;
  summary["closed"] = fit.check.topology.closed;
  summary["manifold"] = fit.check.topology.manifold;
  summary["components"] = fit.check.topology.components;
  summary["genus"] = fit.check.topology.genus;
  summary["similarity_features"] = "ahd";
  summary["filling_rate"] = fit.filling_rate;
  summary["base_spheres"] = fit.base_spheres;
  summary["base_similarity"] = fit.base_similarity;
  summary["sharpness"] = fit.body.blend_exponent * fit.body.a;
  summary["evaluations"] = fit.evaluations;
  return summary;
}

TriangleMesh likeness_for_report(const Recipe& recipe) {
  constexpr int kResolution = 160;
  Recipe like = recipe;
  bool has_relief = false;
  for (Layer& layer : like.layers) {
    ReliefLayer* relief = std::get_if<ReliefLayer>(&layer);
    if (relief == nullptr || relief->pixels == nullptr) continue;
    relief->arrangement = ReliefArrangement::kLike;
    has_relief = true;
  }
  if (!has_relief) return {};
  try {
    return make_coarse_mesh(ImplicitField(like), kResolution);
  } catch (const InputError&) {
    return {};
  }
}

nlohmann::ordered_json details_json(const DetailsFitResult& details) {
  nlohmann::ordered_json roughness = nlohmann::ordered_json::array();
  for (std::size_t k = 0; k < details.lags.size(); ++k) {
    roughness.push_back(
        {{"lag", details.lags[k]}, {"target", details.target_roughness[k]}, {"fit", details.roughness[k]}});
  }
  return {{"evaluations", details.optimization.evaluations}, {"base", score_json(details.base_score)},
          {"start", score_json(details.start_score)},        {"best", score_json(details.score)},
          {"history", details.optimization.history},         {"roughness", roughness}};
}

}  // namespace astrolith
