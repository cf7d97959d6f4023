#include "estimation/gabor/spectrum/log_spectrum_spline.h"

#include <algorithm>
#include <cmath>
#include <complex>
#include <numbers>
#include <utility>

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

// Minimises the penalised Whittle likelihood of log_spectrum_spline.h for one w by Fisher scoring: each step
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
    return looks_ * sum + 0.5 * sum_of_products(s.g, s.rough);
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
    const double slope = sum_of_products(gradient, step);
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

}  // namespace astrolith
