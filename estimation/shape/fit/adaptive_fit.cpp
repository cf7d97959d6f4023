#include "estimation/shape/fit/adaptive_fit.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <limits>
#include <string>
#include <tuple>

#include "estimation/shape/fit/component_repair.h"
#include "estimation/shape/fit/fit_check.h"
#include "estimation/shape/fit/sphere_growth.h"
#include "estimation/shape/model/metaball_model.h"
#include "geometry/mesh_topology.h"

namespace astrolith {
namespace {

// The model of an adaptive fit, with the points that it is refined on and a record of how close it came.
// Lengths are fractions of the target's diagonal. Every distance is the mean |s| over all samples.
class TrackedModel {
 public:
  // The references must outlive this.
  TrackedModel(const TargetBody& target, const SurfaceSamples& samples, const FitPoints& containment,
               const AdaptiveFitOptions& options, const Progress& progress);

  // Begins with this model and measures it.
  void start(const MetaballModel& model);

  // Uses the first `count` samples, or all if there are fewer, in the refinements that follow.
  void use_samples(std::size_t count);

  // Refines the model, measures it, and remembers it if it is the closest so far.
  void refine_for(int iterations);

  // Refines the model as refine_for does. The iterations are not part of the plan that progress reports on.
  void refine_beyond_plan(int iterations);

  // Removes idle metaballs and those outside the target. Then adds new ones where the error is largest: this
  // round's share of the metaballs that are missing from `spheres`. A metaball is idle if it moves the
  // surface by less than `idle_distance`.
  void grow(int spheres, int rounds_left, double idle_distance);

  // Removes additive metaballs whose centre lies outside the target.
  void remove_outside();

  // Makes the closest model measured so far the present one.
  void return_to_best() { summary_.model = best_; }

  // Measures the present model, which so many iterations have led to since the last measurement.
  void measure(int iterations);

  MetaballModel& model() { return summary_.model; }
  FitPoints& points() { return points_; }
  double last_distance() const { return summary_.convergence.back().mean_distance; }
  double best_distance() const { return best_distance_; }
  bool interrupted() const { return summary_.interrupted; }
  // Whether progress asked to stop, or the tolerance is reached.
  bool done() const { return summary_.interrupted || best_distance_ <= options_.tolerance; }

  // Ends the fit with the present model.
  AdaptiveFitSummary take_summary() { return std::move(summary_); }

 private:
  int more_subtractive() const;

  const TargetBody& target_;
  const SurfaceSamples& samples_;
  const AdaptiveFitOptions& options_;
  const Progress& progress_;
  FitPoints points_;
  RefinementOptions refinement_;
  AdaptiveFitSummary summary_;
  MetaballModel best_;
  double best_distance_ = std::numeric_limits<double>::infinity();
  std::string words_ = "starting";  // what progress reports
  int planned_iterations_ = 0;
  double spent_iterations_ = 0.0;
};

// A metaball is removed if its centre lies farther outside the target than this (fraction of the diagonal).
constexpr double kOutsideMargin = 0.002;

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

// A vertex of the fit farther from the target than this is a stray (fraction of the diagonal).
constexpr double kStrayDistance = 0.015;
// Where the fit has a handle, vertices whose normals are not the target's are strays from here on.
constexpr double kTurnedDistance = 0.002;
constexpr int kRepairs = 4;
constexpr std::int64_t kRepairSamples = 20000;

struct MeasuredModel {
  MetaballModel model;
  ComponentComparison components;
  std::int64_t handles = 0;  // more than the target has, or fewer
  double mean_distance = 0.0;

  std::int64_t wrong() const { return components.wrong() + handles; }
  bool better_than(const MeasuredModel& other) const {
    const std::int64_t own = wrong(), others = other.wrong();
    return std::tie(own, mean_distance) < std::tie(others, other.mean_distance);
  }
};

// Adds the stray vertices to the containment points. Returns true if there are none.
bool collect_strays(const TargetBody& target, const FitCheck& check, bool handles, FitPoints& points) {
  const FitPoints strays =
      stray_points(target, check.mesh, kStrayDistance, handles ? kTurnedDistance : kStrayDistance);
  points.inside.insert(points.inside.end(), strays.inside.begin(), strays.inside.end());
  points.outside.insert(points.outside.end(), strays.outside.begin(), strays.outside.end());
  return strays.inside.empty() && strays.outside.empty();
}

void mend(const ComponentComparison& components, int spheres, const AdaptiveFitOptions& options,
          InsideWatch& watch, TrackedModel& fit) {
  remove_islands(fit.model(), components.strays);
  fill_cavities(fit.model(), components.strays, fit.points().on_surface);
  fit.grow(spheres, 1, fit.best_distance());
  watch.add_dips(fit.model(), fit.points().inside);
  fit.refine_beyond_plan(options.relocation_iterations);
}

// Looks for islands, cavities and bridges in the mesh of the model, and repairs them for up to four rounds.
// Islands lose their metaballs, cavities are filled, stray vertices become containment points, and the model
// is refined once more. The present model of `fit` is then the best of the models measured: first the one
// with the fewest wrong components, and among equals the one with the least mean distance.
void repair_surface(const TargetBody& target, const AdaptiveFitOptions& options, InsideWatch& watch,
                    TrackedModel& fit) {
  const auto spheres = static_cast<int>(fit.model().spheres.size());
  const std::int64_t genus = analyze_topology(target.mesh).genus;
  MeasuredModel best;
  for (int repair = 0;; ++repair) {
    fit.remove_outside();
    const FitCheck check =
        check_fit(target, metaball_body(fit.model()), options.repair_resolution, kRepairSamples, 1);
    const MeasuredModel now{fit.model(), compare_components(target, check.mesh),
                            std::abs(check.topology.genus - genus), check.distance.mean};
    if (repair == 0 || now.better_than(best)) best = now;
    const bool complete = static_cast<int>(fit.model().spheres.size()) == spheres;
    const bool clean = collect_strays(target, check, now.handles > 0, fit.points()) && now.wrong() == 0;
    if ((clean && complete) || fit.interrupted() || repair == kRepairs) break;
    mend(now.components, spheres, options, watch, fit);
  }
  fit.model() = std::move(best.model);
}

void grow_to_budget(const AdaptiveFitOptions& options, TrackedModel& fit) {
  for (int round = 0; round < options.rounds && !fit.done(); ++round) {
    fit.grow(options.spheres, options.rounds - round, fit.last_distance());
    fit.refine_for(options.round_iterations);
  }
  if (!fit.done()) fit.refine_for(options.grown_iterations);
}

// Moves the least useful metaballs to where the error is largest. Fewer are moved after a round that gains
// little, down to the last few.
void relocate(const AdaptiveFitOptions& options, InsideWatch& watch, TrackedModel& fit) {
  int count = std::max(1, static_cast<int>(options.relocated * options.spheres));
  const int least = std::max(1, static_cast<int>(options.least_relocated * options.spheres));
  for (int round = 0; round < options.relocations && count >= least && !fit.done(); ++round) {
    fit.return_to_best();
    const double before = fit.best_distance();
    remove_least_useful_spheres(fit.model(), fit.points().on_surface, count);
    fit.grow(options.spheres, 1, before);
    watch.add_dips(fit.model(), fit.points().inside);
    fit.refine_for(options.relocation_iterations);
    if (fit.best_distance() > (1.0 - options.relocation_gain) * before)
      count = 2 * count / options.fewer_relocated;
  }
  fit.return_to_best();
}

void refine_on_all_samples(const AdaptiveFitOptions& options, const SurfaceSamples& samples,
                           InsideWatch& watch, TrackedModel& fit) {
  fit.use_samples(samples.points.size());
  if (!fit.done()) {
    watch.add_dips(fit.model(), fit.points().inside);
    fit.refine_for(options.last_iterations);
  }
  fit.return_to_best();
}

}  // namespace

AdaptiveFitOptions options_for(int spheres) {
  constexpr double kFew = 250.0, kMany = 1000.0;
  const double many = std::clamp((spheres - kFew) / (kMany - kFew), 0.0, 1.0);
  const auto times = [](int count, double factor) { return static_cast<int>(std::lround(count * factor)); };
  AdaptiveFitOptions options;
  options.spheres = spheres;
  options.relocations = times(options.relocations, 1.0 / (1.0 + 2.0 * many) / std::max(1.0, spheres / kMany));
  options.grown_iterations = times(options.grown_iterations, (1.0 + many) / std::max(1.0, spheres / kMany));
  options.relocation_iterations = times(options.relocation_iterations, 1.0 + many);
  options.last_iterations = times(options.last_iterations, 1.0 + many);
  options.least_decrease *= 1.0 + 9.0 * std::clamp((spheres - kMany) / kMany, 0.0, 1.0);
  options.fewer_relocated = times(options.fewer_relocated, 1.0 + many);
  return options;
}

AdaptiveFitSummary fit_adaptively(const TargetBody& target, const MetaballModel& start,
                                  const SurfaceSamples& samples, const FitPoints& containment,
                                  const AdaptiveFitOptions& options, const Progress& progress) {
  InsideWatch watch(target);
  TrackedModel fit(target, samples, containment, options, progress);
  fit.start(start);
  fit.use_samples(std::size_t{static_cast<unsigned>(options.samples_per_sphere)} *
                  static_cast<std::size_t>(options.spheres));
  fit.refine_for(options.first_iterations);
  grow_to_budget(options, fit);
  relocate(options, watch, fit);
  refine_on_all_samples(options, samples, watch, fit);
  if (!fit.interrupted()) repair_surface(target, options, watch, fit);
  fit.measure(0);
  return fit.take_summary();
}

}  // namespace astrolith
