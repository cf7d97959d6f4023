#include "estimation/gabor/gabor_fit.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <string>
#include <utility>

#include "estimation/gabor/lobes/lobe_refinement.h"
#include "estimation/gabor/lobes/lobe_selection.h"
#include "estimation/gabor/spectrum/power_spectrum.h"
#include "numerics/errors.h"
#include "numerics/progress.h"
#include "numerics/sample_statistics.h"
#include "recipe/recipe_json.h"

namespace astrolith {
namespace {

constexpr int kWidestBandwidth = 2;

// The fractions of the work after which the photo's spectrum is known, and of the rest, its estimate.
constexpr double kSpectrumDone = 0.1, kEstimateDone = 0.2;

void require_sides(int width, int height, const std::string& name) {
  if (std::min(width, height) >= kSmallestExemplarSide) return;
  throw InputError(fmt::format("{}: {} x {} pixels are too few for a spectrum; give at least {} x {}", name,
                               width, height, kSmallestExemplarSide, kSmallestExemplarSide));
}

void require_texture(const GreyImage& exemplar, const std::string& name) {
  require_sides(exemplar.width, exemplar.height, name);
  const auto [low, high] = std::minmax_element(exemplar.values.begin(), exemplar.values.end());
  if (*high - *low <= 1e-9 * std::max(std::abs(*high), std::abs(*low))) {
    throw InputError(name + ": all pixels have the same value; give an image with texture");
  }
}

// The power of each frequency, or the share of its strongest neighbour's that leaks from the narrowest lobe
// there.
std::vector<double> least_powers(const PowerSpectrum& spectrum) {
  constexpr double kLeak = 0.02;
  const int w = spectrum.width, h = spectrum.height;
  std::vector<double> powers = spectrum.power;
  for (int y = 0; y < h; ++y) {
    for (int x = 0; x < w; ++x) {
      double& power =
          powers[static_cast<std::size_t>(y) * static_cast<std::size_t>(w) + static_cast<std::size_t>(x)];
      for (const int dy : {h - 1, 0, 1}) {
        for (const int dx : {w - 1, 0, 1}) {
          const std::size_t beside = static_cast<std::size_t>((y + dy) % h) * static_cast<std::size_t>(w) +
                                     static_cast<std::size_t>((x + dx) % w);
          power = std::max(power, kLeak * spectrum.power[beside]);
        }
      }
    }
  }
  return powers;
}

// The weights W of the dictionary's rows, for a spectrum S of unit variance. With sqrt(w / S) a small error
// of the spectrum counts as twice the error of its square root, which the weighted optimal-transport distance
// measures. Beside a line S is what its lobe leaks; with less no lobe would be let in. Frequency 0 holds no
// data.
std::vector<double> row_weights(const SpectrumEstimate& estimate) {
  const std::vector<double>& w = estimate.weights;
  std::vector<double> weight(estimate.spectrum.power.size(), 1.0);
  const std::vector<double> power = least_powers(estimate.spectrum);
  const double unit = estimate.spectrum.variance(), floor = 1e-4;
  for (std::size_t i = 1; i < w.size(); ++i) {
    weight[i] = w[i] / std::sqrt(w[i] * power[i] / unit + floor);
  }
  weight[0] = 0.0;
  return weight;
}

std::vector<SpectralLobe> pursue(GaborFit& fit, const GaborFitOptions& options, const Progress& progress) {
  const PowerSpectrum& target = fit.estimate.spectrum;
  // Division by the variance keeps numbers near 1 for exemplars in any unit.
  const double unit = target.variance();
  PowerSpectrum scaled = target;
  for (double& p : scaled.power) p /= unit;
  const GaborDictionary dictionary(target.width, target.height, kWidestBandwidth,
                                   narrowest_bandwidth(target.width, target.height),
                                   row_weights(fit.estimate));
  BasisPursuitProblem problem{dictionary, std::move(scaled.power), 0.0};
  for (std::size_t i = 0; i < problem.target.size(); ++i) problem.target[i] *= dictionary.weight()[i];
  problem.penalty = options.penalty_ratio * largest_penalty(dictionary, problem.target);
  BasisPursuitOptions pursuit;
  pursuit.relative_gap = options.relative_gap;
  fit.pursuit = solve_working_set(problem, pursuit, progress);
  std::vector<SpectralLobe> lobes = active_lobes(dictionary, fit.pursuit.x);
  for (SpectralLobe& lobe : lobes) lobe.height *= unit;
  fit.pursuit.x = {};
  return lobes;
}

std::vector<SpectralLobe> refined(const std::vector<SpectralLobe>& lobes, const std::vector<double>& weight,
                                  const Progress& progress, GaborFit& fit) {
  RefinedLobes best = fewest_lobes(lobes, fit.estimate, weight, progress);
  fit.refinement_reached = best.reached;
  return std::move(best.lobes);
}

// Where the work was stopped, the strongest lobes take the place of a selection.
std::vector<SpectralLobe> selected(std::vector<SpectralLobe> lobes, const PowerSpectrum& spectrum,
                                   const std::vector<double>& weight, int max_lobes,
                                   const Progress& progress) {
  if (report(progress, 1.0, "selection")) {
    try {
      return select_lobes(lobes, spectrum, weight, max_lobes, progress);
    } catch (const WorkError&) {
    }
  }
  return strongest_lobes(std::move(lobes), max_lobes, spectrum.width, spectrum.height);
}

// The smallest standard deviation of an exemplar. With a smaller one, the variance of a lobe could fall out
// of the range of a recipe.
constexpr double kSmallestContrast = 1e-4;

// The variance of a lobe at frequencies other than 0, which is all of it that a photo shows.
double shown_variance(const SpectralLobe& lobe, int width, int height) {
  const auto at_zero = [&](int n, double center) {
    return periodic_gaussian(n, center * n, lobe_deviation(lobe.bandwidth) * n).front();
  };
  return lobe_variance(lobe, width, height) -
         2.0 * lobe.height / width / height * at_zero(width, lobe.x) * at_zero(height, lobe.y);
}

// A frequency in a recipe. What rounding leaves of 0 is no frequency.
double rounded_frequency(double cycles_per_pixel) {
  constexpr double kNone = 1e-12;
  return std::fabs(cycles_per_pixel) < kNone ? 0.0 : round_to_seven_digits(cycles_per_pixel);
}

// Lobes with variances instead of heights. The variances are scaled so that their sum is the exemplar's
// variance.
std::vector<GaborLobe> to_layer_lobes(const std::vector<SpectralLobe>& lobes, GaborFit& fit) {
  const PowerSpectrum& grid = fit.periodogram;
  std::vector<GaborLobe> result;
  double total = 0.0;
  for (const SpectralLobe& lobe : lobes) {
    const double variance = shown_variance(lobe, grid.width, grid.height);
    total += variance;
    result.push_back({lobe.bandwidth, rounded_frequency(lobe.x), rounded_frequency(lobe.y), variance});
  }
  const double wanted = fit.exemplar_rms * fit.exemplar_rms;
  fit.variance_before_scaling = total / wanted;
  for (GaborLobe& lobe : result) lobe.variance = round_to_seven_digits(lobe.variance * wanted / total);
  std::stable_sort(result.begin(), result.end(),
                   [](const GaborLobe& a, const GaborLobe& b) { return a.variance > b.variance; });
  return result;
}

}  // namespace

GaborFit fit_gabor_lobes(const GreyImage& exemplar, const std::string& name, const GaborFitOptions& options,
                         const Progress& progress) {
  require_texture(exemplar, name);
  PowerSpectrum periodogram =
      exemplar_periodogram(exemplar, options.largest_side, stretch(progress, 0.0, kSpectrumDone));
  if (!(periodogram.variance() > kLeastTexture * sample_variance(exemplar.values))) {
    throw InputError(name + ": holds light from one side or a slope and no texture; use another image");
  }
  GaborFit fit =
      fit_gabor_spectrum(std::move(periodogram), name, options, stretch(progress, kSpectrumDone, 1.0));
  fit.exemplar_mean = sample_mean(exemplar.values);
  return fit;
}

GaborFit fit_gabor_spectrum(PowerSpectrum periodogram, const std::string& name,
                            const GaborFitOptions& options, const Progress& progress) {
  require_sides(periodogram.width, periodogram.height, name);
  GaborFit fit;
  fit.periodogram = std::move(periodogram);
  fit.exemplar_rms = std::sqrt(fit.periodogram.variance());
  if (!(fit.exemplar_rms > kSmallestContrast))
    throw InputError(name +
                     ": has next to no contrast (full scale = 1); rescale it or give an image with texture");
  fit.estimate = estimate_spectrum(fit.periodogram, stretch(progress, 0.0, kEstimateDone));
  const Progress rest = stretch(progress, kEstimateDone, 1.0);
  bool stopped = false;
  const auto heeded = [&](double fraction, std::string_view words) {
    const bool goes_on = report(rest, fraction, words);
    stopped = stopped || !goes_on;
    return goes_on;
  };
  std::vector<SpectralLobe> lobes;
  if (heeded(0.0, "starting")) lobes = pursue(fit, options, heeded);
  fit.pursuit_lobes = static_cast<int>(lobes.size());
  const std::vector<double> weight = row_weights(fit.estimate);
  lobes = selected(std::move(lobes), fit.estimate.spectrum, weight, options.max_lobes, heeded);
  lobes = refined(lobes, weight, heeded, fit);
  if (lobes.empty()) {
    if (stopped) throw WorkError(name + ": stopped before a lobe was found; nothing is written");
    throw InputError(
        name + ": no lobe fits its spectrum; try a smaller penalty, or scale patterns of two pixels up");
  }
  fit.lobes = to_layer_lobes(lobes, fit);
  fit.fitted = layer_spectrum(fit.lobes, fit.periodogram.width, fit.periodogram.height);
  fit.spectrum_distance = optimal_transport_distance(fit.fitted, fit.estimate.spectrum);
  fit.quality = judge_lobes(fit.fitted, fit.periodogram, fit.estimate.standard_error);
  return fit;
}

}  // namespace astrolith
