#include "estimation/gabor/spectrum/spectrum_estimate.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "estimation/gabor/spectrum/fourier_transform.h"
#include "estimation/gabor/spectrum/log_spectrum_spline.h"
#include "estimation/gabor/spectrum/octaves.h"
#include "numerics/errors.h"

namespace astrolith {
namespace {

double bins_per_cycle(const PowerSpectrum& s) { return std::sqrt(static_cast<double>(s.width) * s.height); }

// Smoothing widths in bins, a factor of sqrt(2) apart. They reach from no smoothing to an eighth of the
// distance to the Nyquist frequency.
std::vector<double> widths_tried(const PowerSpectrum& s) {
  std::vector<double> widths;
  for (double w = 0.6; w <= std::max(2.0, bins_per_cycle(s) / 16.0); w *= std::sqrt(2.0)) widths.push_back(w);
  return widths;
}

// The Akaike criterion of a spline g, summed over each octave of |f|.
std::vector<double> octave_scores(const PowerSpectrum& data, const std::vector<double>& g, double parameters,
                                  const std::vector<double>& positions) {
  std::vector<double> scores;
  for (std::size_t i = 1; i < g.size(); ++i) {
    const auto octave = static_cast<std::size_t>(positions[i]);
    if (scores.size() <= octave) scores.resize(octave + 1, 0.0);
    scores[octave] += data.averages * (g[i] + data.power[i] * std::exp(-g[i])) + parameters;
  }
  return scores;
}

// The mean of g(f) and g(-f). They differ by rounding only, unless nearly all bins are empty.
std::vector<double> symmetrised(const std::vector<double>& g, const PowerSpectrum& grid) {
  std::vector<double> mean(g.size());
  const auto w = static_cast<std::size_t>(grid.width);
  const auto h = static_cast<std::size_t>(grid.height);
  for (std::size_t i = 0; i < g.size(); ++i) {
    mean[i] = 0.5 * (g[i] + g[(h - i / w) % h * w + (w - i % w) % w]);
  }
  return mean;
}

// The spline of one width.
struct TriedSpline {
  double width;
  std::vector<double> g;       // ln S on the grid
  std::vector<double> scores;  // by octave
  LogSpectrumSpline::Freedom freedom;
};

// For each octave the index of the spline with the least criterion; the first of equals.
std::vector<std::size_t> best_by_octave(const std::vector<TriedSpline>& tried) {
  std::vector<std::size_t> best(tried[0].scores.size(), 0);
  for (std::size_t octave = 0; octave < best.size(); ++octave) {
    for (std::size_t k = 1; k < tried.size(); ++k) {
      if (tried[k].scores[octave] < tried[best[octave]].scores[octave]) best[octave] = k;
    }
  }
  return best;
}

// Whether no octave is best with one of the last four splines. Spectra of lines end so: wider splines are
// ever worse, and take ever longer.
bool grown_worse(const std::vector<TriedSpline>& tried) {
  constexpr std::size_t kLast = 4;
  if (tried.size() <= kLast) return false;
  const std::vector<std::size_t> best = best_by_octave(tried);
  return *std::max_element(best.begin(), best.end()) + kLast < tried.size();
}

// The splines of all widths, the roughest first; each fit starts from the one before it.
std::vector<TriedSpline> try_widths(const PowerSpectrum& periodogram, const std::vector<double>& positions,
                                    const Progress& progress) {
  const LogSpectrumSpline spline(periodogram);
  std::vector<TriedSpline> tried;
  const std::vector<double> widths = widths_tried(periodogram);
  for (const double w : widths) {
    const double done = static_cast<double>(tried.size()) / static_cast<double>(widths.size());
    const auto at_width = [&](double, std::string_view words) { return report(progress, done, words); };
    TriedSpline next{w, {}, {}, spline.freedom(w)};
    next.g = symmetrised(spline.fit(w, tried.empty() ? std::vector<double>{} : tried.back().g, at_width),
                         periodogram);
    next.scores = octave_scores(periodogram, next.g, next.freedom.parameters, positions);
    tried.push_back(std::move(next));
    if (grown_worse(tried)) break;
  }
  return tried;
}

// A fractional index into a list: `fraction` of the way from `lower` to `upper`.
struct Between {
  std::size_t lower, upper;
  double fraction;

  Between(double index, std::size_t size)
      : lower(static_cast<std::size_t>(index)),
        upper(std::min(lower + 1, size - 1)),
        fraction(index - static_cast<double>(lower)) {}
};

// The fractional index of the spline at log2 |f|, interpolated between octaves. Octave o is centred at o +
// 1/2.
double spline_index(double position, const std::vector<std::size_t>& best) {
  const double index = std::clamp(position - 0.5, 0.0, static_cast<double>(best.size() - 1));
  const Between octave(index, best.size());
  return std::lerp(static_cast<double>(best[octave.lower]), static_cast<double>(best[octave.upper]),
                   octave.fraction);
}

std::vector<OctaveSmoothing> smoothing_of(const std::vector<std::size_t>& best,
                                          const std::vector<TriedSpline>& tried,
                                          const PowerSpectrum& periodogram) {
  std::vector<OctaveSmoothing> smoothing;
  for (std::size_t octave = 0; octave < best.size(); ++octave) {
    smoothing.push_back({std::exp2(static_cast<double>(octave) + 0.5) / bins_per_cycle(periodogram),
                         tried[best[octave]].width});
  }
  return smoothing;
}

// Gives the spectrum S the variance by a change of ln S in proportion to sqrt(S). What is lacking then goes
// to the peaks, which the spline had lowered, and weak frequencies keep their power. In proportion to S,
// which is the change of least squares, narrow ridges are raised too much: .174 in place of .163 from the
// truth on `lines`, as near on other known spectra.
void raise_to_variance(PowerSpectrum& spectrum, double variance) {
  constexpr int kSteps = 30;
  constexpr double kMost = 3.0;  // change of ln S at the peak
  const double peak = *std::max_element(spectrum.power.begin(), spectrum.power.end());
  const double wanted = variance * static_cast<double>(spectrum.power.size());
  double change = 0.0;
  for (int step = 0; step < kSteps; ++step) {
    double sum = 0.0, slope = 0.0;
    for (const double p : spectrum.power) {
      const double raised = p * std::exp(change * std::sqrt(p / peak));
      sum += raised;
      slope += raised * std::sqrt(p / peak);
    }
    const double next = std::clamp(change + (wanted - sum) / slope, -kMost, kMost);
    const bool settled = std::fabs(next - change) < 1e-9;
    change = next;
    if (settled) break;
  }
  for (double& p : spectrum.power) p *= std::exp(change * std::sqrt(p / peak));
  const double gain = variance / spectrum.variance();
  for (double& p : spectrum.power) p *= gain;
}

}  // namespace

SpectrumEstimate estimate_spectrum(const PowerSpectrum& periodogram, const Progress& progress) {
  const std::vector<double> positions = octave_positions(periodogram);
  const std::vector<TriedSpline> tried = try_widths(periodogram, positions, progress);
  const std::vector<std::size_t> best = best_by_octave(tried);
  SpectrumEstimate estimate{periodogram, smoothing_of(best, tried, periodogram), 0.0, {}, 0.0};
  std::vector<double>& power = estimate.spectrum.power;
  const double floor = 1e-12 * periodogram.variance();
  const double peak = *std::max_element(periodogram.power.begin() + 1, periodogram.power.end());
  std::vector<double> variance(power.size(), 0.0);  // of ln S
  power[0] = 0.0;
  for (std::size_t i = 1; i < power.size(); ++i) {
    const Between spline(spline_index(positions[i], best), tried.size());
    const TriedSpline& rough = tried[spline.lower];
    const double g = std::lerp(rough.g[i], tried[spline.upper].g[i], spline.fraction);
    power[i] = std::clamp(std::exp(g), floor, peak);
    variance[i] = rough.freedom.variance;
  }
  raise_to_variance(estimate.spectrum, periodogram.variance());
  estimate.weights = octave_weights(estimate.spectrum);
  double error = 0.0, weighted = 0.0;
  for (std::size_t i = 1; i < power.size(); ++i) {
    error += power[i] * variance[i] / 4.0;
    weighted += estimate.weights[i] * power[i] * variance[i] / 4.0;
  }
  const double total = estimate.spectrum.variance() * static_cast<double>(power.size());
  estimate.standard_error = std::sqrt(error / total);
  estimate.weighted_error = std::sqrt(weighted / total);
  return estimate;
}

}  // namespace astrolith
