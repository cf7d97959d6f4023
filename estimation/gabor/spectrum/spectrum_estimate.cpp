#include "estimation/gabor/spectrum/spectrum_estimate.h"

#include <algorithm>
#include <cmath>
#include <complex>
#include <numbers>
#include <utility>

#include "estimation/gabor/spectrum/fourier_transform.h"
#include "estimation/gabor/spectrum/power_spectrum.h"
#include "numerics/errors.h"
#include "numerics/sample_statistics.h"

namespace astrolith {
namespace {

// The squared factor of the first difference on frequency k, along an axis of n bins. `step` is the length of
// a bin over the square root of the bins' area.
double squared_difference(int k, int n, double step) {
  const double s = 2.0 * std::sin(std::numbers::pi * k / n) / step;
  return s * s;
}

std::vector<double> log_periodogram(const PowerSpectrum& periodogram) {
  const double floor = 1e-12 * periodogram.variance();  // for bins without power
  std::vector<double> g;
  for (const double p : periodogram.power) g.push_back(std::log(std::max(p, floor)));
  g[0] = 0.5 * (g[1] + g[static_cast<std::size_t>(periodogram.width)]);  // frequency 0 holds no data
  return g;
}

// A spline g and the gradient of its roughness penalty, w^6 L^3 g.
struct Spline {
  std::vector<double> g, rough;
};

// Minimises the penalised Whittle likelihood of the spline for one w by Fisher scoring: each step
// is the gradient divided by the expected Hessian n + w^6 L^3.
class WhittleFit {
 public:
  WhittleFit(const PowerSpectrum& periodogram, const FourierTransform& fourier,
             const std::vector<double>& cubed_laplacian, double w)
      : periodogram_(periodogram),
        fourier_(fourier),
        cubed_laplacian_(cubed_laplacian),
        looks_(periodogram.averages),
        penalty_(std::pow(w, 6)),
        half_(fourier.half_size()) {}

  std::vector<double> minimize(std::vector<double> start, const Progress& progress) {
    constexpr int kMaxSteps = 60;
    const std::size_t n = start.size();
    const double negligible = 1e-6 * looks_ * static_cast<double>(n);
    Spline now{std::move(start), std::vector<double>(n)};
    Spline trial{std::vector<double>(n), std::vector<double>(n)};
    multiply_by_penalty(now.g, now.rough);
    double value = objective(now);
    for (int k = 0; k < kMaxSteps; ++k) {
      if (!report(progress, 0.0, "smoothing")) {
        throw WorkError("stopped before the spectrum was estimated; nothing is written");
      }
      const double trial_value = search_along_scoring_step(now, value, trial);
      if (!(trial_value < value)) break;
      std::swap(now, trial);
      const bool settled = value - trial_value < negligible;
      value = trial_value;
      if (settled) break;
    }
    return std::move(now.g);
  }

 private:
  // sum over f != 0 of n (g + I exp(-g)) + 1/2 g' w^6 L^3 g
  double objective(const Spline& s) const {
    double sum = 0.0;
    for (std::size_t i = 1; i < s.g.size(); ++i) sum += s.g[i] + periodogram_.power[i] * std::exp(-s.g[i]);
    return looks_ * sum + 0.5 * dot_product(s.g, s.rough);
  }

  std::vector<double> gradient(const Spline& s) const {
    std::vector<double> gradient(s.g.size());
    for (std::size_t i = 0; i < s.g.size(); ++i) {
      const double likelihood = i == 0 ? 0.0 : looks_ * (1.0 - periodogram_.power[i] * std::exp(-s.g[i]));
      gradient[i] = likelihood + s.rough[i];
    }
    return gradient;
  }

  // Halves the step until the value falls enough (Armijo). Returns the value at the last trial.
  double search_along_scoring_step(const Spline& now, double value, Spline& trial) {
    const std::vector<double> gradient = this->gradient(now);
    std::vector<double> step(gradient.size());
    divide_by_hessian(gradient, step);
    const double slope = dot_product(gradient, step);
    double trial_value = value;
    for (double length = 1.0; length > 1e-3; length *= 0.5) {
      for (std::size_t i = 0; i < step.size(); ++i) trial.g[i] = now.g[i] - length * step[i];
      multiply_by_penalty(trial.g, trial.rough);
      trial_value = objective(trial);
      if (trial_value <= value - 1e-4 * length * slope) break;
    }
    return trial_value;
  }

  void multiply_by_penalty(const std::vector<double>& in, std::vector<double>& out) {
    convolve(in, out, [](double penalty) { return penalty; });
  }

  void divide_by_hessian(const std::vector<double>& in, std::vector<double>& out) {
    convolve(in, out, [this](double penalty) { return 1.0 / (looks_ + penalty); });
  }

  // Multiplies by factor(w^6 L^3) in Fourier space.
  template <typename Factor>
  void convolve(const std::vector<double>& in, std::vector<double>& out, const Factor& factor) {
    fourier_.forward(in, half_);
    for (std::size_t i = 0; i < half_.size(); ++i) half_[i] *= factor(penalty_ * cubed_laplacian_[i]);
    fourier_.inverse(half_, out);
  }

  const PowerSpectrum& periodogram_;
  const FourierTransform& fourier_;
  const std::vector<double>& cubed_laplacian_;
  double looks_;    // n
  double penalty_;  // w^6
  std::vector<std::complex<double>> half_;
};

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

std::vector<OctaveSmoothing> octave_smoothing(const std::vector<std::size_t>& best,
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

LogSpectrumSpline::LogSpectrumSpline(const PowerSpectrum& periodogram)
    : periodogram_(periodogram), fourier_(periodogram.width, periodogram.height) {
  const double aspect = static_cast<double>(periodogram.height) / periodogram.width;
  for (int y = 0; y < periodogram.height; ++y) {
    for (int x = 0; x < fourier_.half_width(); ++x) {
      const double laplacian = squared_difference(x, periodogram.width, std::sqrt(aspect)) +
                               squared_difference(y, periodogram.height, 1.0 / std::sqrt(aspect));
      cubed_laplacian_.push_back(laplacian * laplacian * laplacian);
    }
  }
}

std::vector<double> LogSpectrumSpline::fit(double w, std::vector<double> start,
                                           const Progress& progress) const {
  WhittleFit whittle(periodogram_, fourier_, cubed_laplacian_, w);
  if (start.empty()) start = log_periodogram(periodogram_);
  return whittle.minimize(std::move(start), progress);
}

LogSpectrumSpline::Freedom LogSpectrumSpline::freedom(double w) const {
  const double penalty = std::pow(w, 6);
  const double looks = periodogram_.averages;
  const auto bins = static_cast<double>(fourier_.grid_size());
  Freedom sum;
  std::size_t i = 0;
  for (int y = 0; y < fourier_.height(); ++y) {
    for (int x = 0; x < fourier_.half_width(); ++x, ++i) {
      const bool alone = x == 0 || 2 * x == fourier_.width();  // a column that holds its own mirror image
      const double share = (alone ? 1.0 : 2.0) / bins;
      const double h = looks / (looks + penalty * cubed_laplacian_[i]);
      sum.parameters += share * h;
      sum.variance += share * h * h / looks;
    }
  }
  return sum;
}

SpectrumEstimate estimate_spectrum(const PowerSpectrum& periodogram, const Progress& progress) {
  const std::vector<double> positions = octave_positions(periodogram);
  const std::vector<TriedSpline> tried = try_widths(periodogram, positions, progress);
  const std::vector<std::size_t> best = best_by_octave(tried);
  SpectrumEstimate estimate{periodogram, octave_smoothing(best, tried, periodogram), 0.0, {}, 0.0};
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
