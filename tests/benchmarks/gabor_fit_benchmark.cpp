// Measures how near fit_gabor comes to known spectra, and how well it continues photos: the tables of the
// README.
#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <cmath>
#include <filesystem>
#include <iostream>
#include <nlohmann/json.hpp>
#include <vector>

#include "estimation/gabor/gabor_fit.h"
#include "estimation/gabor/image/image_reader.h"
#include "estimation/gabor/pursuit/gabor_dictionary.h"
#include "estimation/gabor/spectrum/spectrum_distance.h"
#include "numerics/files/output_file.h"
#include "tests/benchmarks/held_out_square.h"
#include "tests/estimation/gabor/known_spectrum.h"

namespace astrolith::testing {
namespace {

struct Options {
  int seeds = 20;
  std::string only;
  std::string images;
  std::string json;
  int side = 256;
  GaborFitOptions fit;
};

// |a - truth| / |truth| over all frequencies but 0. The peaks dominate it.
double relative_l2_distance(const PowerSpectrum& a, const PowerSpectrum& truth) {
  double difference = 0.0, norm = 0.0;
  for (std::size_t i = 1; i < truth.power.size(); ++i) {
    const double t = truth.power[i], d = a.power[i] - t;
    difference += d * d;
    norm += t * t;
  }
  return norm > 0.0 ? std::sqrt(difference / norm) : 0.0;
}

// The root mean square of ln(a / truth) over the frequencies where the truth is at least 1e-3 of its mean,
// since weaker frequencies are invisible in a texture. `a` is raised to at least 1e-6 of the truth's mean.
double log_spectral_distance(const PowerSpectrum& a, const PowerSpectrum& truth) {
  const double mean = truth.variance();
  double sum = 0.0;
  std::size_t count = 0;
  for (std::size_t i = 1; i < truth.power.size(); ++i) {
    if (truth.power[i] < 1e-3 * mean || truth.power[i] <= 0.0) continue;
    const double ratio = std::log(std::max(a.power[i], 1e-6 * mean) / truth.power[i]);
    sum += ratio * ratio;
    ++count;
  }
  return count > 0 ? std::sqrt(sum / static_cast<double>(count)) : 0.0;
}

struct Distances {
  double transport = 0.0, l2 = 0.0, log = 0.0;

  void add(const PowerSpectrum& estimate, const PowerSpectrum& truth, double share) {
    transport += share * optimal_transport_distance(estimate, truth);
    l2 += share * relative_l2_distance(estimate, truth);
    log += share * log_spectral_distance(estimate, truth);
  }
  nlohmann::ordered_json json() const {
    return {{"relative_ot", transport}, {"relative_l2", l2}, {"log_spectral", log}};
  }
};

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

// The width that is best on average over the realisations, chosen with knowledge of the truth.
std::pair<double, Distances> best_smoothing(const std::vector<PowerSpectrum>& periodograms,
                                            const PowerSpectrum& truth) {
  std::pair<double, Distances> best{0.0, {}};
  for (double deviation = 0.5; deviation < 10.0; deviation *= 1.1) {
    Distances d;
    for (const PowerSpectrum& p : periodograms) {
      d.add(smoothed(p, deviation), truth, 1.0 / static_cast<double>(periodograms.size()));
    }
    if (best.first == 0.0 || d.transport < best.second.transport) best = {deviation, d};
  }
  return best;
}

nlohmann::ordered_json measure_known(const NamedSpectrum& known, const Options& options) {
  Distances raw, estimate, lobes;
  double count = 0.0;
  double standard_error = 0.0;
  std::vector<PowerSpectrum> periodograms;
  const double share = 1.0 / options.seeds;
  for (int seed = 1; seed <= options.seeds; ++seed) {
    const GreyImage image = realisation_of(known.spectrum, static_cast<std::uint64_t>(seed));
    periodograms.push_back(power_spectrum(image));
    raw.add(periodograms.back(), known.spectrum, share);
    const GaborFit fit = fit_gabor_lobes(image, known.name, options.fit);
    estimate.add(fit.estimate.spectrum, known.spectrum, share);
    lobes.add(fit.fitted, known.spectrum, share);
    standard_error += share * fit.estimate.standard_error;
    count += share * static_cast<double>(fit.lobes.size());
  }
  const auto [deviation, oracle] = best_smoothing(periodograms, known.spectrum);
  fmt::print(
      "{:18} {:6.3f} {:6.3f} ({:.1f}) {:8.3f} {:6.3f} {:9.3f} {:6.1f} | {:6.3f} {:8.3f} {:8.3f} | {:6.3f} "
      "{:8.3f} {:8.3f}\n",
      known.name, raw.transport, oracle.transport, deviation, estimate.transport, standard_error,
      lobes.transport, count, raw.l2, oracle.l2, lobes.l2, raw.log, oracle.log, lobes.log);
  std::fflush(stdout);
  return {{"spectrum", known.name},
          {"periodogram", raw.json()},
          {"best_smoothed", oracle.json()},
          {"best_deviation", deviation},
          {"estimate", estimate.json()},
          {"standard_error", standard_error},
          {"fit", lobes.json()},
          {"lobes", count}};
}

nlohmann::ordered_json measure_spectra(const Options& options) {
  fmt::print("known spectra, 128 x 128, {} realisations each, at most {} lobes\n", options.seeds,
             options.fit.max_lobes);
  fmt::print("{:18} {:>51} | {:^24} | {:^24}\n", "", "relative OT distance to the truth", "relative L2",
             "log-spectral");
  fmt::print("{:18} {:>6} {:>12} {:>8} {:>6} {:>9} {:>6} | {:>6} {:>8} {:>8} | {:>6} {:>8} {:>8}\n",
             "spectrum", "raw", "best smooth", "estimate", "s.e.", "fit_gabor", "lobes", "raw", "smooth",
             "fit", "raw", "smooth", "fit");
  auto rows = nlohmann::ordered_json::array();
  std::vector<NamedSpectrum> spectra = known_spectra();
  spectra.push_back({"smooth", smooth_spectrum()});
  for (const NamedSpectrum& known : spectra) {
    if (known.name.find(options.only) != std::string::npos) rows.push_back(measure_known(known, options));
  }
  return rows;
}

nlohmann::ordered_json measure_photo(const std::filesystem::path& file, const Options& options) {
  const HeldOut h = measure_held_out(read_grey_image(file).image, options.side, 5, options.fit);
  fmt::print(
      "{:40} {:5} {:6.3f} {:6.3f} {:6.3f} {:6.3f} | {:6.3f} {:8.3f} {:6.3f} {:6.3f} | {:6.3f} {:5.1f} {:6} "
      "{:6.2f} {:8.1e}\n",
      file.filename().string(), h.pairs, h.photo, h.random_phase, h.lobes, h.lobes / h.random_phase,
      h.expected_random_phase, h.expected_estimate, h.expected_lobes,
      h.expected_lobes / h.expected_random_phase, h.variance_ratio, h.lobe_count, h.largest_recipe, h.seconds,
      h.largest_gap);
  std::fflush(stdout);
  return {{"image", file.filename().string()},
          {"pairs", h.pairs},
          {"photo", h.photo},
          {"random_phase", h.random_phase},
          {"fit", h.lobes},
          {"ratio", h.lobes / h.random_phase},
          {"expected_random_phase", h.expected_random_phase},
          {"expected_estimate", h.expected_estimate},
          {"expected_fit", h.expected_lobes},
          {"expected_ratio", h.expected_lobes / h.expected_random_phase},
          {"variance_synthesized", h.variance_ratio},
          {"lobes", h.lobe_count},
          {"recipe_bytes", h.largest_recipe},
          {"seconds", h.seconds},
          {"pursuit_gap", h.largest_gap}};
}

nlohmann::ordered_json measure_photos(const Options& options) {
  std::vector<std::filesystem::path> files;
  for (const auto& entry : std::filesystem::directory_iterator(options.images)) {
    const std::string extension = entry.path().extension().string();
    const bool wanted = entry.path().filename().string().find(options.only) != std::string::npos;
    if (wanted && (extension == ".png" || extension == ".jpg" || extension == ".tif"))
      files.push_back(entry.path());
  }
  std::sort(files.begin(), files.end());
  fmt::print("held-out squares of {} px: relative OT distance of Welch spectra from the right square\n",
             options.side);
  fmt::print("{:46} {:^27} | {:^29} |\n", "", "five syntheses", "expected spectra");
  fmt::print(
      "{:40} {:>5} {:>6} {:>6} {:>6} {:>6} | {:>6} {:>8} {:>6} {:>6} | {:>6} {:>5} {:>6} {:>6} {:>8}\n",
      "photo", "pairs", "left", "phase", "fit", "ratio", "phase", "estimate", "fit", "ratio", "var", "lobes",
      "bytes", "s", "gap");
  auto rows = nlohmann::ordered_json::array();
  for (const auto& file : files) rows.push_back(measure_photo(file, options));
  return rows;
}

void run(const Options& options) {
  nlohmann::ordered_json result;
  if (options.seeds > 0) result["spectra"] = measure_spectra(options);
  if (!options.images.empty()) result["photos"] = measure_photos(options);
  if (options.json.empty()) return;
  OutputFile file(options.json);
  const std::string text = result.dump(2) + '\n';
  file.write(text.data(), text.size());
  file.commit();
}

}  // namespace
}  // namespace astrolith::testing

int main(int argc, char** argv) {
  using namespace astrolith::testing;
  Options options;
  CLI::App app("Measures fit_gabor against known spectra and against held-out squares of photos");
  app.add_option("--seeds", options.seeds, "realisations of each known spectrum; 0 leaves them out");
  app.add_option("--only", options.only, "only spectra and photos whose names hold this");
  app.add_option("--images", options.images, "folder of photos");
  app.add_option("--side", options.side, "of the held-out squares, pixels");
  app.add_option("--lobes", options.fit.max_lobes);
  app.add_option("--penalty", options.fit.penalty_ratio);
  app.add_option("--json", options.json, "file for the figures");
  CLI11_PARSE(app, argc, argv);
  try {
    run(options);
  } catch (const std::exception& error) {
    std::cerr << error.what() << '\n';
    return 1;
  }
  return 0;
}
