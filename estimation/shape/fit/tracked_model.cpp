#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "estimation/shape/fit/sphere_growth.h"
#include "estimation/shape/fit/tracked_model_internal.h"
#include "estimation/shape/model/model_levels.h"

namespace astrolith {
namespace {

// A metaball is removed if its centre lies farther outside the target than this (fraction of the diagonal).
constexpr double kOutsideMargin = 0.002;

}  // namespace

TrackedModel::TrackedModel(const TargetBody& target, const SurfaceSamples& samples,
                           const FitPoints& containment, const AdaptiveFitOptions& options,
                           const Progress& progress)
    : target_(target), samples_(samples), options_(options), progress_(progress), points_(containment) {
  refinement_.loss_scale = options.loss_scale;
  refinement_.containment_weight = options.containment_weight;
  refinement_.keep_centers_inside = &target.tree;
  refinement_.relative_decrease = options.least_decrease;
  planned_iterations_ = options.first_iterations + options.rounds * options.round_iterations +
                        options.grown_iterations + options.relocations * options.relocation_iterations +
                        options.last_iterations;
}

void TrackedModel::start(const MetaballModel& model) {
  summary_.model = best_ = model;
  measure(0);
}

void TrackedModel::use_samples(std::size_t count) {
  const auto end = static_cast<std::ptrdiff_t>(std::min(count, samples_.points.size()));
  points_.on_surface.assign(samples_.points.begin(), samples_.points.begin() + end);
}

void TrackedModel::refine_for(int iterations) {
  refinement_.max_iterations = iterations;
  // A loss with a scale far below the mean distance would follow the nearer half of the surface only.
  refinement_.loss_scale = std::max(options_.loss_scale, last_distance());
  const RefinementSummary refined =
      refine(summary_.model, points_, refinement_, [&](double part, std::string_view) {
        const double spent = spent_iterations_ + part * iterations;
        return report(progress_, std::min(1.0, spent / planned_iterations_), words_);
      });
  spent_iterations_ += iterations;
  summary_.model = refined.model;
  summary_.interrupted = refined.interrupted;
  measure(refined.iterations);
  if (last_distance() >= best_distance_) return;
  best_distance_ = last_distance();
  best_ = summary_.model;
}

void TrackedModel::refine_beyond_plan(int iterations) {
  spent_iterations_ -= iterations;
  refine_for(iterations);
}

void TrackedModel::remove_outside() { remove_outside_spheres(summary_.model, target_.tree, kOutsideMargin); }

void TrackedModel::grow(int spheres, int rounds_left, double idle_distance) {
  std::vector<ModelSphere>& own = summary_.model.spheres;
  remove_outside();
  remove_idle_spheres(summary_.model, points_, idle_distance);
  const int missing = spheres - static_cast<int>(own.size());
  const int count = (missing + rounds_left - 1) / rounds_left;
  const std::vector<ModelSphere> grown = spheres_for_largest_errors(
      summary_.model, samples_, {target_.area, options_.spheres, count, more_subtractive()});
  own.insert(own.end(), grown.begin(), grown.end());
}

// How many more metaballs may be subtractive.
int TrackedModel::more_subtractive() const {
  constexpr int kFewest = 8;  // fewer metaballs than that have no room for dents, which eat the body up
  if (options_.spheres < kFewest) return 0;
  const std::vector<ModelSphere>& spheres = summary_.model.spheres;
  const auto subtractive =
      std::count_if(spheres.begin(), spheres.end(), [](const ModelSphere& s) { return s.subtractive; });
  return std::max(0,
                  static_cast<int>(options_.subtractive * options_.spheres) - static_cast<int>(subtractive));
}

void TrackedModel::measure(int iterations) {
  double sum = 0.0;
  for (const double s : model_distances(summary_.model, samples_.points)) sum += std::abs(s);
  const double mean = sum / static_cast<double>(samples_.points.size());
  const int before = summary_.convergence.empty() ? 0 : summary_.convergence.back().iterations;
  summary_.convergence.push_back(
      {before + iterations, static_cast<int>(summary_.model.spheres.size()), mean});
  words_ = fmt::format("{} spheres, mean distance {:.4f} %", summary_.model.spheres.size(), 100.0 * mean);
}

}  // namespace astrolith
