#include "estimation/gabor/spectrum/log_spectrum_spline.h"

#include <algorithm>
#include <cmath>
#include <complex>
#include <numbers>

namespace astrolith {
namespace {

// Squared factor of the difference along an axis of n bins, in units of the square root of the bins' area.
double squared_difference(int k, int n, double step) {
  const double s = 2.0 * std::sin(std::numbers::pi * k / n) / step;
  return s * s;
}

double dot(const std::vector<double>& a, const std::vector<double>& b) {
  double sum = 0.0;
  for (std::size_t i = 0; i < a.size(); ++i) sum += a[i] * b[i];
  return sum;
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

double LogSpectrumSpline::objective(const std::vector<double>& g, const std::vector<double>& rough) const {
  double sum = 0.0;
  for (std::size_t i = 1; i < g.size(); ++i) sum += g[i] + periodogram_.power[i] * std::exp(-g[i]);
  return periodogram_.averages * sum + 0.5 * dot(g, rough);
}

std::vector<double> LogSpectrumSpline::fit(double w, std::vector<double> g) const {
  const std::size_t n = periodogram_.power.size();
  const double looks = periodogram_.averages;
  const double penalty = std::pow(w, 6);
  // Bins without power pull g down with a bounded force; only a start needs a logarithm of them.
  const double floor = 1e-12 * periodogram_.variance();
  if (g.empty()) {
    for (const double p : periodogram_.power) g.push_back(std::log(std::max(p, floor)));
    g[0] = 0.5 * (g[1] + g[static_cast<std::size_t>(periodogram_.width)]);  // frequency 0 holds no data
  }
  std::vector<std::complex<double>> half(fourier_.half_size());
  std::vector<double> rough(n), step(n), trial(n), trial_rough(n), gradient(n);
  const auto apply = [&](const std::vector<double>& in, std::vector<double>& out, const auto& factor) {
    fourier_.forward(in, half);
    for (std::size_t i = 0; i < half.size(); ++i) half[i] *= factor(penalty * cubed_laplacian_[i]);
    fourier_.inverse(half, out);
  };
  const auto itself = [](double p) { return p; };

  constexpr int kMaxSteps = 60;
  const double negligible = 1e-6 * looks * static_cast<double>(n);
  apply(g, rough, itself);
  double value = objective(g, rough);
  for (int k = 0; k < kMaxSteps; ++k) {
    for (std::size_t i = 0; i < n; ++i) {
      const double likelihood = i == 0 ? 0.0 : looks * (1.0 - periodogram_.power[i] * std::exp(-g[i]));
      gradient[i] = likelihood + rough[i];
    }
    apply(gradient, step, [looks](double p) { return 1.0 / (looks + p); });
    const double slope = dot(gradient, step);
    double length = 1.0;
    double trial_value = value;
    for (; length > 1e-3; length *= 0.5) {
      for (std::size_t i = 0; i < n; ++i) trial[i] = g[i] - length * step[i];
      apply(trial, trial_rough, itself);
      trial_value = objective(trial, trial_rough);
      if (trial_value <= value - 1e-4 * length * slope) break;
    }
    if (!(trial_value < value)) break;
    std::swap(g, trial);
    std::swap(rough, trial_rough);
    const bool settled = value - trial_value < negligible;
    value = trial_value;
    if (settled) break;
  }
  return g;
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
