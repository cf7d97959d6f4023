#include "estimation/shape/fit/adaptive_fit.h"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <limits>
#include <tuple>

#include "estimation/shape/fit/component_repair.h"
#include "estimation/shape/fit/fit_check.h"
#include "estimation/shape/fit/sphere_growth.h"

namespace astrolith {
namespace {

// Centres may stick out of the target this far (fraction of the diagonal) before their sphere is taken away.
constexpr double kOutsideMargin = 0.002;

// Surfaces further than this from the target, as a fraction of the diagonal, are strays to be mended.
constexpr double kStrayDistance = 0.015;
constexpr int kRepairs = 4;
constexpr std::int64_t kRepairSamples = 20000;

class AdaptiveFit {
 public:
  AdaptiveFit(const TargetBody& target, const SurfaceSamples& samples, const FitPoints& containment,
              const AdaptiveFitOptions& options, const Progress& progress)
      : target_(target),
        samples_(samples),
        points_(containment),
        watch_(target),
        options_(options),
        progress_(progress) {
    refinement_.loss_scale = options.loss_scale;
    refinement_.containment_weight = options.containment_weight;
    refinement_.keep_centers_inside = &target.tree;
    total_iterations_ = options.first_iterations + options.rounds * options.round_iterations +
                        options.grown_iterations + options.relocations * options.relocation_iterations +
                        options.last_iterations;
  }

  AdaptiveFitSummary run(const MetaballModel& start) {
    summary_.model = best_ = start;
    note(0);
    see_samples(std::size_t{static_cast<unsigned>(options_.samples_per_sphere)} *
                static_cast<std::size_t>(options_.spheres));
    step(options_.first_iterations);
    grow_to_budget();
    relocate();
    see_samples(samples_.points.size());
    if (!done()) {
      watch_.add_dips(summary_.model, points_.inside);
      step(options_.last_iterations);
    }
    summary_.model = best_;
    if (!summary_.interrupted) finish();
    note(0);
    return std::move(summary_);
  }

 private:
  double mean_distance() const { return summary_.convergence.back().mean_distance; }

  bool done() const { return summary_.interrupted || best_distance_ <= options_.tolerance; }

  void see_samples(std::size_t count) {
    const auto end = static_cast<std::ptrdiff_t>(std::min(count, samples_.points.size()));
    points_.on_surface.assign(samples_.points.begin(), samples_.points.begin() + end);
  }

  void grow_to_budget() {
    for (int round = 0; round < options_.rounds && !done(); ++round) {
      grow(options_.spheres, options_.rounds - round, mean_distance());
      step(options_.round_iterations);
    }
    if (!done()) step(options_.grown_iterations);
  }

  // Takes the least useful spheres to where the error is largest; fewer of them after a round in vain.
  void relocate() {
    int count = std::max(1, static_cast<int>(options_.relocated * options_.spheres));
    for (int round = 0; round < options_.relocations && count > 0 && !done(); ++round) {
      summary_.model = best_;
      const double before = best_distance_;
      remove_least_useful_spheres(summary_.model, points_.on_surface, count);
      grow(options_.spheres, 1, best_distance_);
      watch_.add_dips(summary_.model, points_.inside);
      step(options_.relocation_iterations);
      if (best_distance_ >= before) count = 2 * count / 3;
    }
    summary_.model = best_;
  }

  void step(int iterations) {
    refinement_.max_iterations = iterations;
    // While most of the surface is further away than the loss's scale, that would follow the nearer half.
    if (!summary_.convergence.empty())
      refinement_.loss_scale = std::max(options_.loss_scale, mean_distance());
    const RefinementSummary refined =
        refine(summary_.model, points_, refinement_, [&](double part, std::string_view) {
          return report(progress_, std::min(1.0, (spent_ + part * iterations) / total_iterations_), words_);
        });
    spent_ += iterations;
    summary_.model = refined.model;
    summary_.interrupted = refined.interrupted;
    note(refined.iterations);
    if (mean_distance() >= best_distance_) return;
    best_distance_ = mean_distance();
    best_ = summary_.model;
  }

  // Adds a point to the convergence, so many iterations after the last.
  void note(int iterations) {
    double sum = 0.0;
    for (const double s : model_distances(summary_.model, samples_.points)) sum += std::abs(s);
    const double mean = sum / static_cast<double>(samples_.points.size());
    const int before = summary_.convergence.empty() ? 0 : summary_.convergence.back().iterations;
    summary_.convergence.push_back(
        {before + iterations, static_cast<int>(summary_.model.spheres.size()), mean});
    char words[64];
    std::snprintf(words, sizeof words, "%zu spheres, mean distance %.4f %%", summary_.model.spheres.size(),
                  100.0 * mean);
    words_ = words;
  }

  // Adds this round's share of what is missing up to `wanted` spheres, to a model so far from the target.
  void grow(int wanted, int rounds_left, double mean) {
    std::vector<ModelSphere>& spheres = summary_.model.spheres;
    remove_outside_spheres(summary_.model, target_.tree, kOutsideMargin);
    remove_idle_spheres(summary_.model, points_, mean);
    const int missing = wanted - static_cast<int>(spheres.size());
    const int count = (missing + rounds_left - 1) / rounds_left;
    const std::vector<ModelSphere> grown = spheres_for_largest_errors(
        summary_.model, samples_, {target_.area, options_.spheres, count, more_subtractive()});
    spheres.insert(spheres.end(), grown.begin(), grown.end());
  }

  // How many more spheres may take away.
  int more_subtractive() const {
    if (summary_.model.kernel != Kernel::kGaussian) return 0;
    const std::vector<ModelSphere>& spheres = summary_.model.spheres;
    const auto subtractive =
        std::count_if(spheres.begin(), spheres.end(), [](const ModelSphere& s) { return s.subtractive; });
    return std::max(
        0, static_cast<int>(options_.subtractive * options_.spheres) - static_cast<int>(subtractive));
  }

  // Looks for islands, cavities and bridges, and mends them: islands lose their spheres, cavities are filled,
  // strays become containment points, and the model is refined once more. The best model measured is the one
  // that stays.
  void finish() {
    const auto wanted = static_cast<int>(summary_.model.spheres.size());
    Measured best;
    for (int repair = 0;; ++repair) {
      remove_outside_spheres(summary_.model, target_.tree, kOutsideMargin);
      const FitCheck check =
          check_fit(target_, metaball_body(summary_.model), options_.repair_resolution, kRepairSamples, 1);
      Measured now{summary_.model, compare_parts(target_, check.mesh), check.distance.mean};
      if (repair == 0 || now < best) best = now;
      const bool complete = static_cast<int>(summary_.model.spheres.size()) == wanted;
      const bool clean = collect_strays(check) && now.parts.wrong() == 0;
      if ((clean && complete) || summary_.interrupted || repair == kRepairs) break;
      mend(now.parts, wanted);
    }
    summary_.model = std::move(best.model);
  }

  void mend(const PartsComparison& parts, int wanted) {
    remove_islands(summary_.model, parts.strays);
    fill_cavities(summary_.model, parts.strays, points_.on_surface);
    grow(wanted, 1, best_distance_);
    watch_.add_dips(summary_.model, points_.inside);
    spent_ -= options_.relocation_iterations;
    step(options_.relocation_iterations);
  }

  // Fewer parts too many or missing come first, then the mean distance.
  struct Measured {
    MetaballModel model;
    PartsComparison parts;
    double mean_distance = 0.0;
    bool operator<(const Measured& other) const {
      const std::int64_t wrong = parts.wrong(), others = other.parts.wrong();
      return std::tie(wrong, mean_distance) < std::tie(others, other.mean_distance);
    }
  };

  // True when there were none.
  bool collect_strays(const FitCheck& check) {
    const FitPoints strays = stray_points(target_, check.mesh, kStrayDistance);
    points_.inside.insert(points_.inside.end(), strays.inside.begin(), strays.inside.end());
    points_.outside.insert(points_.outside.end(), strays.outside.begin(), strays.outside.end());
    return strays.inside.empty() && strays.outside.empty();
  }

  const TargetBody& target_;
  const SurfaceSamples& samples_;
  FitPoints points_;
  InsideWatch watch_;
  const AdaptiveFitOptions& options_;
  const Progress& progress_;
  RefinementOptions refinement_;
  AdaptiveFitSummary summary_;
  MetaballModel best_;
  double best_distance_ = std::numeric_limits<double>::infinity();
  std::string words_ = "starting";
  int total_iterations_ = 0;
  double spent_ = 0.0;
};

}  // namespace

AdaptiveFitSummary fit_adaptively(const TargetBody& target, const MetaballModel& start,
                                  const SurfaceSamples& samples, const FitPoints& containment,
                                  const AdaptiveFitOptions& options, const Progress& progress) {
  return AdaptiveFit(target, samples, containment, options, progress).run(start);
}

}  // namespace astrolith
