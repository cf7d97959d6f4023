#include "estimation/gabor/spectrum/spectrum_estimate.h"

#include <algorithm>
#include <cmath>

#include "estimation/gabor/spectrum/fourier_transform.h"
#include "estimation/gabor/spectrum/log_spectrum_spline.h"

namespace astrolith {
namespace {

double bins_per_cycle(const PowerSpectrum& s) { return std::sqrt(static_cast<double>(s.width) * s.height); }

// log2 |f| of every grid point but frequency 0, |f| in bins and at least one.
std::vector<double> octave_positions(const PowerSpectrum& s) {
  std::vector<double> positions;
  positions.reserve(s.power.size());
  for (int y = 0; y < s.height; ++y) {
    const double fy = static_cast<double>(signed_frequency(y, s.height)) / s.height;
    for (int x = 0; x < s.width; ++x) {
      const double fx = static_cast<double>(signed_frequency(x, s.width)) / s.width;
      positions.push_back(std::log2(std::max(1.0, std::hypot(fx, fy) * bins_per_cycle(s))));
    }
  }
  return positions;
}

// A factor of sqrt(2) apart, from no smoothing to an eighth of the distance to the Nyquist frequency.
std::vector<double> widths_tried(const PowerSpectrum& s) {
  std::vector<double> widths;
  for (double w = 0.6; w <= std::max(2.0, bins_per_cycle(s) / 16.0); w *= std::sqrt(2.0)) widths.push_back(w);
  return widths;
}

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

// Mean of g(f) and g(-f), which differ by rounding only, unless nearly all bins are empty.
std::vector<double> symmetrised(const std::vector<double>& g, const PowerSpectrum& grid) {
  std::vector<double> mean(g.size());
  const auto w = static_cast<std::size_t>(grid.width);
  const auto h = static_cast<std::size_t>(grid.height);
  for (std::size_t i = 0; i < g.size(); ++i) {
    mean[i] = 0.5 * (g[i] + g[(h - i / w) % h * w + (w - i % w) % w]);
  }
  return mean;
}

}  // namespace

SpectrumEstimate estimate_spectrum(const PowerSpectrum& periodogram) {
  const LogSpectrumSpline spline(periodogram);
  const std::vector<double> positions = octave_positions(periodogram);
  const std::vector<double> widths = widths_tried(periodogram);
  std::vector<std::vector<double>> logs;
  std::vector<std::vector<double>> scores;
  std::vector<LogSpectrumSpline::Freedom> freedom;
  for (const double w : widths) {
    logs.push_back(
        symmetrised(spline.fit(w, logs.empty() ? std::vector<double>{} : logs.back()), periodogram));
    freedom.push_back(spline.freedom(w));
    scores.push_back(octave_scores(periodogram, logs.back(), freedom.back().parameters, positions));
  }

  SpectrumEstimate estimate{periodogram, {}, 0.0};
  std::vector<double> choice;  // index into widths by octave
  for (std::size_t octave = 0; octave < scores[0].size(); ++octave) {
    std::size_t best = 0;
    for (std::size_t k = 1; k < widths.size(); ++k) {
      if (scores[k][octave] < scores[best][octave]) best = k;
    }
    choice.push_back(static_cast<double>(best));
    estimate.smoothing.push_back(
        {std::exp2(static_cast<double>(octave) + 0.5) / bins_per_cycle(periodogram), widths[best]});
  }
  const double floor = 1e-12 * periodogram.variance();
  const auto last = static_cast<double>(choice.size() - 1);
  double error = 0.0;
  for (std::size_t i = 1; i < periodogram.power.size(); ++i) {
    // Octave o is centred at o + 1/2.
    const double position = std::clamp(positions[i] - 0.5, 0.0, last);
    const auto lower = static_cast<std::size_t>(position);
    const std::size_t upper = std::min(lower + 1, choice.size() - 1);
    const double k = std::lerp(choice[lower], choice[upper], position - static_cast<double>(lower));
    const auto rough = static_cast<std::size_t>(k);
    const std::size_t smooth = std::min(rough + 1, widths.size() - 1);
    const double g = std::lerp(logs[rough][i], logs[smooth][i], k - static_cast<double>(rough));
    estimate.spectrum.power[i] = std::max(floor, std::exp(g));
    error += estimate.spectrum.power[i] * freedom[rough].variance / 4.0;
  }
  estimate.spectrum.power[0] = 0.0;
  estimate.standard_error =
      std::sqrt(error / (estimate.spectrum.variance() * static_cast<double>(periodogram.power.size())));
  const double gain = periodogram.variance() / estimate.spectrum.variance();
  for (double& p : estimate.spectrum.power) p *= gain;
  return estimate;
}

}  // namespace astrolith
