#include "estimation/shape/fit/adaptive_fit.h"

#include <algorithm>
#include <cmath>

#include "estimation/shape/fit/component_repair.h"
#include "estimation/shape/fit/sphere_growth.h"
#include "estimation/shape/fit/surface_repair_internal.h"
#include "estimation/shape/fit/tracked_model_internal.h"

namespace astrolith {
namespace {

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
