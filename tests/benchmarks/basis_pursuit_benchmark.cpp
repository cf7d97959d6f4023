// Writes the basis pursuit problems of a photo for solvers that want a matrix, and how fast ours is:
//
//   basis_pursuit_benchmark gravel.png FOLDER && pursuit_peers.py FOLDER
//
// The upper left 32 x 32 pixels of the photo are used, with bandwidths from 2 to the narrowest. One problem
// is their periodogram (the problem of Galerne et al. 2012), another their estimated spectrum with the
// weights that fit_gabor gives it.
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

constexpr int kSide = 32;
constexpr double kPenalty = 0.01;  // over the largest useful one

GreyImage corner(const GreyImage& image) {
  GreyImage square{kSide, kSide, {}};
  for (int y = 0; y < kSide; ++y) {
    for (int x = 0; x < kSide; ++x) square.values.push_back(image.at(x, y));
  }
  return square;
}

void write_doubles(const std::filesystem::path& file, std::span<const double> values) {
  std::ofstream(file, std::ios::binary)
      .write(reinterpret_cast<const char*>(values.data()), values.size_bytes());
}

// Writes STEM.json, and float64 arrays in STEM.matrix (column by column) and STEM.target.
void write_problem(const std::string& stem, const PowerSpectrum& spectrum, std::vector<double> weight) {
  weight[0] = 0.0;
  const GaborDictionary dictionary(spectrum.width, spectrum.height, 2,
                                   narrowest_bandwidth(spectrum.width, spectrum.height), std::move(weight));
  BasisPursuitProblem problem{dictionary, spectrum.power, 0.0};
  for (std::size_t i = 0; i < problem.target.size(); ++i) problem.target[i] *= dictionary.weight()[i];
  problem.penalty = kPenalty * largest_penalty(dictionary, problem.target);

  nlohmann::json history = nlohmann::json::array();
  const auto now = [] { return std::chrono::steady_clock::now(); };
  const auto start = now();
  std::vector<double> seconds;  // time of each check of the certificate
  const BasisPursuitResult ours = solve_working_set(problem, {1e-6, 1000000}, [&](double, std::string_view) {
    seconds.push_back(std::chrono::duration<double>(now() - start).count());
    return true;
  });
  for (std::size_t i = 0; i < seconds.size(); ++i)
    history.push_back({{"seconds", seconds[i]}, {"relative_gap", ours.history[i].relative_gap}});

  std::vector<double> matrix(dictionary.rows() * dictionary.size()), unit(dictionary.size(), 0.0);
  for (std::size_t j = 0; j < dictionary.size(); ++j) {
    unit[j] = 1.0;
    dictionary.synthesize(unit, {matrix.data() + j * dictionary.rows(), dictionary.rows()});
    unit[j] = 0.0;
  }
  write_doubles(stem + ".matrix", matrix);
  write_doubles(stem + ".target", problem.target);
  std::ofstream(stem + ".json") << nlohmann::json{
      {"rows", dictionary.rows()}, {"columns", dictionary.size()},      {"penalty", problem.penalty},
      {"primal", ours.primal},     {"relative_gap", ours.relative_gap}, {"history", history}};
}

void write_problems(const std::string& photo, const std::filesystem::path& folder) {
  PowerSpectrum periodogram = exemplar_periodogram(corner(read_image(photo, false).planes[0]));
  const double variance = periodogram.variance();
  for (double& p : periodogram.power) p /= variance;
  const std::string stem = (folder / std::filesystem::path(photo).stem()).string();
  write_problem(stem + "_periodogram", periodogram, std::vector<double>(periodogram.power.size(), 1.0));
  const PowerSpectrum estimate = estimate_spectrum(periodogram).spectrum;
  std::vector<double> weight;
  for (const double p : estimate.power) weight.push_back(1.0 / std::sqrt(p + 1e-6));
  write_problem(stem + "_estimate", estimate, std::move(weight));
}

}  // namespace
}  // namespace astrolith

int main(int argc, char** argv) {
  if (argc != 3) return 2;
  astrolith::write_problems(argv[1], argv[2]);
}
