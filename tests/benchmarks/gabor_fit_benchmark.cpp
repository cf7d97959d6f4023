// Measures how near fit_gabor comes to known spectra: prints a row of JSON for each, with relative optimal-
// transport distances to the truth.
//
//   gabor_fit_benchmark REALISATIONS [ONLY]      ONLY: a part of the names of the spectra
#include <fmt/format.h>

#include <algorithm>
#include <cstdlib>
#include <nlohmann/json.hpp>
#include <vector>

#include "estimation/gabor/gabor_fit.h"
#include "estimation/gabor/pursuit/gabor_dictionary.h"
#include "estimation/gabor/spectrum/power_spectrum.h"
#include "tests/estimation/gabor/known_spectrum.h"

namespace astrolith::testing {
namespace {

// The baseline: the periodogram convolved with a Gaussian of one width everywhere, with frequency 0 left out.
PowerSpectrum smoothed(const PowerSpectrum& periodogram, double deviation) {
  const int n = periodogram.width;
  const FourierTransform fourier(n, n);
  const std::vector<double> kernel = periodic_gaussian(n, 0.0, deviation);
  PowerSpectrum result = periodogram;
  std::vector<double> grid(result.power.size());
  const auto convolve = [&](std::vector<double>& data) {
    std::vector<std::complex<double>> a(fourier.half_size()), b(fourier.half_size());
    for (std::size_t i = 0; i < grid.size(); ++i) {
      grid[i] = kernel[i % static_cast<std::size_t>(n)] * kernel[i / static_cast<std::size_t>(n)];
    }
    fourier.forward(grid, a);
    fourier.forward(data, b);
    for (std::size_t i = 0; i < a.size(); ++i) a[i] *= b[i];
    fourier.inverse(a, data);
  };
  std::vector<double> mask(grid.size(), 1.0);
  mask[0] = 0.0;
  convolve(mask);
  convolve(result.power);
  for (std::size_t i = 0; i < mask.size(); ++i) {
    result.power[i] = i == 0 ? 0.0 : std::max(0.0, result.power[i]) / std::max(mask[i], 1e-12);
  }
  return result;
}

// The least mean distance over the widths, chosen with knowledge of the truth.
double best_smoothing(const std::vector<PowerSpectrum>& periodograms, const PowerSpectrum& truth) {
  double best = 1e300;
  for (double deviation = 0.5; deviation < 10.0; deviation *= 1.1) {
    double mean = 0.0;
    for (const PowerSpectrum& p : periodograms) {
      mean += optimal_transport_distance(smoothed(p, deviation), truth) /
              static_cast<double>(periodograms.size());
    }
    best = std::min(best, mean);
  }
  return best;
}

void print_row(const NamedSpectrum& known, int realisations) {
  double raw = 0.0, lobes = 0.0, count = 0.0;
  std::vector<PowerSpectrum> periodograms;
  const double share = 1.0 / realisations;
  for (int seed = 1; seed <= realisations; ++seed) {
    const GreyImage image = draw_realisation(known.spectrum, static_cast<std::uint64_t>(seed));
    periodograms.push_back(power_spectrum(image));
    raw += share * optimal_transport_distance(periodograms.back(), known.spectrum);
    const GaborFit fit = fit_gabor_lobes(image, known.name, {});
    lobes += share * optimal_transport_distance(fit.fitted, known.spectrum);
    count += share * static_cast<double>(fit.lobes.size());
  }
  fmt::print("{}\n", nlohmann::ordered_json{{"spectrum", known.name},
                                            {"periodogram", raw},
                                            {"best_smoothed", best_smoothing(periodograms, known.spectrum)},
                                            {"fit", lobes},
                                            {"lobes", count}}
                         .dump());
  std::fflush(stdout);
}

}  // namespace
}  // namespace astrolith::testing

int main(int argc, char** argv) {
  using namespace astrolith::testing;
  if (argc < 2) return 2;
  std::vector<NamedSpectrum> spectra = known_spectra();
  spectra.push_back({"smooth", smooth_spectrum()});
  for (const NamedSpectrum& known : spectra) {
    if (argc < 3 || known.name.find(argv[2]) != std::string::npos) print_row(known, std::atoi(argv[1]));
  }
}
