#include "estimation/shape/learning/learnt_details.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>

#include "estimation/shape/learning/imaged_ground.h"
#include "numerics/errors.h"
#include "numerics/portable_double.h"

namespace astrolith {
namespace {

constexpr double kInfinite = std::numeric_limits<double>::infinity();
constexpr const char* kImagedGroup = "imaged";
constexpr int kCalibrations = 3;
constexpr int kGeneration = 8;
// The seeds that decide are none of the recipe's own and of the next ones, by which a fit is judged later.
constexpr int kFirstFreshDraw = 101;
// A mean skewness beyond this shows boulders or craters.
constexpr double kClearSkewnessLack = 0.05;

void check_learning_options(const LearningOptions& options) {
  if (options.noise_evaluations < 1 || options.landform_evaluations < 1 || options.search_draws < 1 ||
      options.deciding_seeds < 1) {
    throw InputError("evaluations, draws and deciding seeds: give at least 1");
  }
}

// Thrown where progress asked to stop.
struct Stopped {};

class Learning {
 public:
  Learning(const LearningOptions& options, const Progress& progress)
      : options_(options),
        progress_([this, &progress](double, std::string_view words) { return told(progress, words); }) {
    expected_ = options.search_draws *
                    (1 + kCalibrations + options.noise_evaluations + options.landform_evaluations) +
                3 * options.deciding_seeds;
  }

  LearntDetails run(const TargetBody& target, const Recipe& base) {
    try {
      measure_.emplace(target, base, options_.candidate, progress_);
      result_.edge = measure_->edge();
      if (!options_.everywhere) leave_out_smooth_ground(target, base);
      learn();
    } catch (const Stopped&) {
      result_.interrupted = true;
    } catch (const WorkError&) {
      if (!stopped_) throw;
      result_.interrupted = true;
    }
    result_.evaluations = evaluations_;
    result_.recipe = measure_ ? measure_->base() : base;
    result_.recipe.layers = layers(result_.model);
    return std::move(result_);
  }

 private:
  // Passes the share of the whole work on. Heeds a wish to stop once and for all.
  bool told(const Progress& progress, std::string_view words) {
    const double share = std::min(1.0, static_cast<double>(evaluations_) / std::max(expected_, 1));
    if (!report(progress, share, words)) stopped_ = true;
    return !stopped_;
  }

  std::vector<Layer> layers(const SurfaceModel& model) const {
    return layers_of(model, result_.edge, group_, result_.edge);
  }

  // Ties the layers to the metaballs whose ground has details in the target.
  void leave_out_smooth_ground(const TargetBody& target, const Recipe& base) {
    const MetaballBody body = in_target_frame(target, *base.body);
    const ImagedGround ground = find_imaged_ground(measure_->target_statistics(), body.spheres);
    if (ground.metaballs.empty()) return;
    result_.smooth_share = ground.smooth_share;
    group_ = kImagedGroup;
    measure_->add_group({group_, ground.metaballs});
  }

  // The means over the draws that the search sees: one draw may have more rough ground than another.
  CandidateFigures searched_figures(const SurfaceModel& model) {
    const int draws = varies(model) ? options_.search_draws : 1;
    CandidateFigures mean;
    for (int draw = 0; draw < draws; ++draw) {
      const CandidateFigures figures = figures_of(model, draw, false);
      mean.distance += figures.distance / draws;
      mean.variance_ratio += figures.variance_ratio / draws;
      mean.skewness_lack += figures.skewness_lack / draws;
      for (const auto& [radius, rougher] : figures.rougher) mean.rougher[radius] += rougher / draws;
    }
    return mean;
  }

  static bool varies(const SurfaceModel& model) {
    return model.amplitude > 0.0 || model.landforms != LandformKind::none;
  }

  CandidateFigures figures_of(const SurfaceModel& model, int draw, bool with_similarity) {
    if (stopped_) throw Stopped{};
    try {
      CandidateFigures figures = measure_->figures(layers(model), draw, with_similarity, progress_);
      ++evaluations_;
      return figures;
    } catch (const WorkError&) {
      if (stopped_) throw Stopped{};
      throw;
    }
  }

  void learn() {
    const CandidateFigures bare = searched_figures({});
    const SurfaceModel noise = searched(calibrated(first_noise(), bare), options_.noise_evaluations);
    const CandidateFigures of_noise = searched_figures(noise);
    result_.skewness_lack = of_noise.skewness_lack;
    judge("bare base", {});
    result_.candidates.back().kept = true;
    judge("noise", noise);
    const JudgedCandidate& base = result_.candidates[0];
    JudgedCandidate& of_seeds = result_.candidates[1];
    if (of_seeds.distance >= base.distance || of_seeds.similarity <= base.similarity) {
      of_seeds.reason = reason_against(of_seeds, base, false);
    }
    of_seeds.kept = of_seeds.reason.empty();
    result_.model = of_seeds.kept ? noise : SurfaceModel{};
    if (std::fabs(result_.skewness_lack) < kClearSkewnessLack) return;
    learn_landforms(noise, of_noise);
  }

  // The start of the noise: waves from 24 edges down, and regions as large as the correlation of roughness
  // over distance says.
  SurfaceModel first_noise() const {
    SurfaceModel model;
    const SurfaceStatistics& target = measure_->target_statistics();
    const LocalStatistic* roughness = target.find(SurfaceQuantity::roughness, 3.0);
    std::vector<double> values = roughness->values;
    std::nth_element(values.begin(), values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2),
                     values.end());
    // Noise with a gain of one half has a residual within 3 edges of about a tenth of its first octave.
    model.amplitude = 3.0 * portable::exp(values[values.size() / 2]) * 8.0;
    const double far = std::clamp(target.regions.correlation(1), 0.0, 0.4);
    model.mask_wavelength = target.body_radius * (0.5 + far);
    model.contrast = 0.3;
    return model;
  }

  // Corrects amplitude, gain and contrast by what a candidate lacks, some times over.
  SurfaceModel calibrated(SurfaceModel model, const CandidateFigures& bare) {
    for (int k = 0; k < kCalibrations; ++k) {
      const CandidateFigures figures = searched_figures(model);
      correct_noise(figures, bare, model);
      correct_contrast(figures, model);
    }
    return model;
  }

  // The logarithm of the factor by which the noise is too weak within a radius. Squares of roughness add up,
  // and the base has its share.
  static double lack(const CandidateFigures& figures, const CandidateFigures& bare, double radius) {
    constexpr double kMost = 1.0, kLeastShare = 0.02;
    const auto squared = [](double rougher) { return portable::exp(2.0 * rougher); };
    const double of_base = squared(bare.rougher.at(radius));
    const double have = std::max(squared(figures.rougher.at(radius)) - of_base, kLeastShare * of_base);
    const double want = std::max(1.0 - of_base, 1e-4);
    return std::clamp(0.5 * portable::log(want / have), -kMost, kMost);
  }

  static void correct_noise(const CandidateFigures& figures, const CandidateFigures& bare,
                            SurfaceModel& model) {
    const bool wide = figures.rougher.contains(6.0);
    const double near = lack(figures, bare, 3.0), far = wide ? lack(figures, bare, 6.0) : near;
    // From one radius to its double lies about one octave of lacunarity 1.95.
    model.gain = std::clamp(model.gain * portable::exp(0.5 * (near - far)), 0.2, 0.85);
    model.amplitude *= portable::exp(far);
  }

  static void correct_contrast(const CandidateFigures& figures, SurfaceModel& model) {
    if (figures.variance_ratio <= 0.0) return;
    const double factor = std::clamp(1.0 / figures.variance_ratio, 0.25, 4.0);
    model.contrast = std::clamp(model.contrast * std::sqrt(factor), 0.05, 4.0);
  }

  // The best model that the search finds around a centre.
  SurfaceModel searched(const SurfaceModel& centre, int evaluations) {
    const std::size_t n = searched_numbers(centre.landforms);
    result_.model = centre;
    SurfaceModel best = centre;
    double least = kInfinite;
    const BatchObjective objective = [&](std::span<const std::vector<double>> points) {
      std::vector<double> values;
      for (const std::vector<double>& x : points) {
        values.push_back(distance_at(centre, x));
        if (values.back() >= least) continue;
        least = values.back();
        best = result_.model = model_at(centre, x);
      }
      return values;
    };
    OptimizeOptions optimize;
    optimize.algorithm = options_.optimizer;
    optimize.population = kGeneration;
    optimize.max_evaluations = evaluations;
    optimize.seed = options_.seed;
    optimize.start.assign(n, 0.0);
    const Bounds bounds{std::vector<double>(n, -1.0), std::vector<double>(n, 1.0)};
    const OptimizeResult found = minimize(objective, bounds, optimize, progress_);
    result_.history.insert(result_.history.end(), found.history.begin(), found.history.end());
    if (stopped_) throw Stopped{};
    return best;
  }

  // Infinite once progress asked to stop, which the log does not keep.
  double distance_at(const SurfaceModel& centre, const std::vector<double>& x) {
    if (stopped_) return kInfinite;
    if (options_.log != nullptr) {
      if (const std::optional<double> known = options_.log->find(x)) return *known;
    }
    try {
      const double distance = searched_figures(model_at(centre, x)).distance;
      if (options_.log != nullptr) options_.log->add(x, distance);
      return distance;
    } catch (const Stopped&) {
      return kInfinite;
    }
  }

  void learn_landforms(const SurfaceModel& noise, const CandidateFigures& of_noise) {
    const SurfaceModel kept = result_.model;
    SurfaceModel model = with_landforms(noise, of_noise);
    try {
      model = searched(model, options_.landform_evaluations);
      result_.model = kept;
      judge(name_of(model.landforms), model);
    } catch (const Stopped&) {
      // Landforms that nothing has judged are not kept.
      result_.model = kept;
      throw;
    }
    JudgedCandidate& landforms = result_.candidates.back();
    const JudgedCandidate& before = result_.candidates[result_.candidates[1].kept ? 1 : 0];
    landforms.reason = reason_against(landforms, before, true);
    landforms.kept = landforms.reason.empty();
    if (landforms.kept) result_.model = model;
  }

  // The start of a population, in proportion to the skewness that the noise lacks. The noise gives way.
  SurfaceModel with_landforms(SurfaceModel model, const CandidateFigures& of_noise) const {
    const double lack = of_noise.skewness_lack;
    const auto points = static_cast<double>(measure_->target_statistics().points);
    const double strength = std::clamp(std::fabs(lack) / 0.25, 0.25, 2.0);
    model.amplitude *= 0.75;
    model.count = 0.025 * points * strength;
    if (lack > 0.0) {
      model.landforms = LandformKind::boulders;
      model.exponent = 2.9;
      model.least = 2.5;
      model.greatest = 18.0;
      model.shape = 0.45;
    } else {
      model.landforms = LandformKind::craters;
      model.exponent = 1.8;
      model.least = 3.0;
      model.greatest = 20.0;
      model.shape = 0.08;
    }
    return model;
  }

  // Adds the means over fresh seeds of a model's figures to the candidates.
  void judge(const std::string& name, const SurfaceModel& model) {
    JudgedCandidate judged;
    judged.name = name;
    judged.model = model;
    const int draws = varies(model) ? options_.deciding_seeds : 1;
    for (int k = 0; k < draws; ++k) {
      const CandidateFigures figures = figures_of(model, kFirstFreshDraw + k, true);
      judged.distance += figures.distance / draws;
      judged.held_out += figures.held_out / draws;
      judged.similarity += figures.similarity / draws;
      judged.variance_ratio += figures.variance_ratio / draws;
      judged.components += static_cast<double>(figures.components) / draws;
      judged.genus += static_cast<double>(figures.genus) / draws;
    }
    result_.candidates.push_back(judged);
  }

  // Why a candidate is no better than the one before; empty if it is.
  static std::string reason_against(const JudgedCandidate& candidate, const JudgedCandidate& before,
                                    bool by_held_out) {
    if (candidate.distance >= before.distance) {
      return fmt::format("the surface statistics came no nearer: {:.3f} after {:.3f}", candidate.distance,
                         before.distance);
    }
    if (by_held_out && candidate.held_out >= before.held_out) {
      return fmt::format("the kurtosis, which the search did not see, came no nearer: {:.3f} after {:.3f}",
                         candidate.held_out, before.held_out);
    }
    if (candidate.similarity <= before.similarity) {
      return fmt::format("the shape histogram came no nearer: similarity {:.3f} after {:.3f}",
                         candidate.similarity, before.similarity);
    }
    return "";
  }

  LearningOptions options_;
  Progress progress_;
  bool stopped_ = false;
  std::int64_t evaluations_ = 0;
  int expected_ = 1;
  LearntDetails result_;
  std::string group_;  // of metaballs with details; empty: all
  std::optional<CandidateMeasure> measure_;
};

}  // namespace

LearntDetails learn_details(const TargetBody& target, const Recipe& base, const LearningOptions& options,
                            const Progress& progress) {
  check_learning_options(options);
  return Learning(options, progress).run(target, base);
}

}  // namespace astrolith
