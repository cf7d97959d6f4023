// The model of an adaptive fit, with the points that it is refined on and a record of how close it came.
#pragma once

#include <limits>
#include <string>

#include "estimation/shape/fit/adaptive_fit.h"

namespace astrolith {

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

}  // namespace astrolith
