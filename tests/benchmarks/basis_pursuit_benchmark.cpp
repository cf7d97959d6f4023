// Measures the seconds to a certified gap: the working set beside FISTA, on the power spectra of photos.
//
//   basis_pursuit_benchmark gravel.png grass.png sand.png
//   basis_pursuit_benchmark gravel.png --side 32 --export FOLDER && pursuit_peers.py FOLDER
//
// The upper left square of each photo is used, with bandwidths from 2 to the narrowest. One problem is its
// periodogram (the problem of Galerne et al. 2012), another its estimated spectrum with the weights that
// fit_gabor gives it. FISTA stops after a time limit.
#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <chrono>
#include <cmath>
#include <filesystem>
#include <fstream>
#include <nlohmann/json.hpp>

#include "estimation/gabor/image/image_reader.h"
#include "estimation/gabor/pursuit/basis_pursuit.h"
#include "estimation/gabor/spectrum/power_spectrum.h"
#include "estimation/gabor/spectrum/spectrum_estimate.h"

namespace astrolith {
namespace {

constexpr double kGaps[] = {1e-1, 1e-2, 1e-3, 1e-4, 1e-5, 1e-6};

struct Options {
  std::vector<std::string> images;
  int side = 256;
  double penalty = 0.01;
  double fista_seconds = 60.0;
  std::string export_folder;  // folder for problems for other solvers; empty = none
};

double now() {
  return std::chrono::duration<double>(std::chrono::steady_clock::now().time_since_epoch()).count();
}

GreyImage corner(const GreyImage& image, int side) {
  GreyImage square{std::min(side, image.width), std::min(side, image.height), {}};
  for (int y = 0; y < square.height; ++y) {
    for (int x = 0; x < square.width; ++x) square.values.push_back(image.at(x, y));
  }
  return square;
}

struct Run {
  BasisPursuitResult result;
  std::vector<double> seconds;  // time of each check of the certificate
};

template <typename Solver>
Run timed(const Solver& solve, const BasisPursuitProblem& problem, double limit) {
  Run run;
  const double start = now();
  BasisPursuitOptions options;
  options.relative_gap = kGaps[std::size(kGaps) - 1];
  options.max_iterations = 1000000;
  run.result = solve(problem, options, [&](double, std::string_view) {
    run.seconds.push_back(now() - start);
    return run.seconds.back() < limit;
  });
  return run;
}

// The certified gap keeps the best bound, but the gap of an iterate may rise. The first iterate that reaches
// the goal counts.
std::string row(const Run& run) {
  std::string text;
  for (const double gap : kGaps) {
    std::size_t i = 0;
    while (i < run.result.history.size() && run.result.history[i].relative_gap > gap) ++i;
    text += i < run.result.history.size() ? fmt::format(" {:8.2f}", run.seconds[i]) : "        -";
  }
  const auto atoms =
      std::count_if(run.result.x.begin(), run.result.x.end(), [](double x) { return x > 0.0; });
  return text + fmt::format("  {:9.1e} {:6} {:6}", run.result.relative_gap, run.result.iterations, atoms);
}

void write_doubles(const std::filesystem::path& file, std::span<const double> values) {
  std::ofstream(file, std::ios::binary)
      .write(reinterpret_cast<const char*>(values.data()), values.size_bytes());
}

// Exports the problem for solvers that want a matrix: FOLDER/NAME.json, and float64 arrays in .matrix (column
// by column) and .target beside it.
void write_problem(const std::string& folder, const std::string& name, const BasisPursuitProblem& problem,
                   const Run& ours) {
  const GaborDictionary& dictionary = problem.dictionary;
  std::vector<double> matrix(dictionary.rows() * dictionary.size()), unit(dictionary.size(), 0.0);
  for (std::size_t j = 0; j < dictionary.size(); ++j) {
    unit[j] = 1.0;
    dictionary.synthesize(unit, {matrix.data() + j * dictionary.rows(), dictionary.rows()});
    unit[j] = 0.0;
  }
  const std::filesystem::path stem = std::filesystem::path(folder) / name;
  write_doubles(stem.string() + ".matrix", matrix);
  write_doubles(stem.string() + ".target", problem.target);
  nlohmann::json gaps = nlohmann::json::array();
  for (std::size_t i = 0; i < ours.seconds.size(); ++i)
    gaps.push_back({{"seconds", ours.seconds[i]}, {"relative_gap", ours.result.history[i].relative_gap}});
  std::ofstream(stem.string() + ".json") << nlohmann::json{{"rows", dictionary.rows()},
                                                           {"columns", dictionary.size()},
                                                           {"penalty", problem.penalty},
                                                           {"primal", ours.result.primal},
                                                           {"relative_gap", ours.result.relative_gap},
                                                           {"history", gaps}};
}

void compare(const std::string& name, const PowerSpectrum& spectrum, std::vector<double> weight,
             const Options& o) {
  weight[0] = 0.0;
  const double start = now();
  const GaborDictionary dictionary(spectrum.width, spectrum.height, 2,
                                   narrowest_bandwidth(spectrum.width, spectrum.height), std::move(weight));
  BasisPursuitProblem problem{dictionary, spectrum.power, 0.0};
  for (std::size_t i = 0; i < problem.target.size(); ++i) problem.target[i] *= dictionary.weight()[i];
  problem.penalty = o.penalty * largest_penalty(dictionary, problem.target);
  fmt::print("{}: {} atoms, dictionary in {:.2f} s\n", name, dictionary.size(), now() - start);
  const auto working_set = [](const auto& p, const auto& options, const Progress& progress) {
    return solve_working_set(p, options, progress);
  };
  const Run ours = timed(working_set, problem, 1e9);
  fmt::print("  working set {}\n", row(ours));
  if (!o.export_folder.empty()) write_problem(o.export_folder, name, problem, ours);
  if (o.fista_seconds > 0.0)
    fmt::print("  FISTA       {}\n", row(timed(solve_fista, problem, o.fista_seconds)));
  std::fflush(stdout);
}

void measure(const std::string& file, const Options& o) {
  PowerSpectrum periodogram = exemplar_periodogram(corner(read_grey_image(file).image, o.side));
  const double variance = periodogram.variance();
  for (double& p : periodogram.power) p /= variance;
  const std::string name = std::filesystem::path(file).stem().string();
  compare(name + "_periodogram", periodogram, std::vector<double>(periodogram.power.size(), 1.0), o);
  const PowerSpectrum estimate = estimate_spectrum(periodogram).spectrum;
  std::vector<double> weight;
  for (const double p : estimate.power) weight.push_back(1.0 / std::sqrt(p + 1e-6));
  compare(name + "_estimate", estimate, std::move(weight), o);
}

}  // namespace
}  // namespace astrolith

int main(int argc, char** argv) {
  using namespace astrolith;
  CLI::App app("Seconds to certified duality gaps, working set against FISTA");
  Options o;
  app.add_option("images", o.images, "photos")->required()->check(CLI::ExistingFile);
  app.add_option("--side", o.side, "of the square taken, pixels")->capture_default_str();
  app.add_option("--penalty", o.penalty, "over the largest useful one")->capture_default_str();
  app.add_option("--fista-seconds", o.fista_seconds, "FISTA stops after so long; 0 = leave it out")
      ->capture_default_str();
  app.add_option("--export", o.export_folder, "folder for the problems as matrices, which grow with side^4")
      ->check(CLI::ExistingDirectory);
  CLI11_PARSE(app, argc, argv);
  fmt::print("seconds to a gap of");
  for (const double gap : kGaps) fmt::print(" {:>7.0e}", gap);
  fmt::print("   gap at end  steps  lobes\n");
  for (const std::string& file : o.images) measure(file, o);
  return 0;
}
