// Measures how often the test of Gaussianity raises a false alarm: its p-values on simulated Gaussian
// textures, which should be uniform. Spectra and sizes vary, and textures are whole periods or, as in photos,
// squares cut out of larger ones.
#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <cmath>
#include <functional>

#include "estimation/gabor/gaussianity.h"
#include "tests/estimation/gabor/known_spectrum.h"

namespace astrolith {
namespace {

// The power at (fx, fy), in cycles per pixel.
using Shape = std::function<double(double, double)>;

PowerSpectrum spectrum_of(const Shape& shape, int n) {
  PowerSpectrum s{n, n, {}};
  for (int y = 0; y < n; ++y) {
    for (int x = 0; x < n; ++x) {
      const double fx = static_cast<double>(signed_frequency(x, n)) / n;
      const double fy = static_cast<double>(signed_frequency(y, n)) / n;
      s.power.push_back(x == 0 && y == 0 ? 0.0 : shape(fx, fy));
    }
  }
  const double variance = s.variance();
  for (double& p : s.power) p /= variance;
  return s;
}

GreyImage corner(const GreyImage& image, int n) {
  GreyImage square{n, n, {}};
  for (int y = 0; y < n; ++y) {
    for (int x = 0; x < n; ++x) square.values.push_back(image.at(x, y));
  }
  return square;
}

void measure(const std::string& name, const Shape& shape, int n, bool cut, int count) {
  const PowerSpectrum spectrum = spectrum_of(shape, cut ? 2 * n : n);
  std::vector<double> p;
  int outside = 0;
  for (int seed = 1; seed <= count; ++seed) {
    const GreyImage whole = testing::realisation_of(spectrum, static_cast<std::uint64_t>(seed));
    const Gaussianity g = test_gaussianity(cut ? corner(whole, n) : whole, 1);
    p.push_back(g.p_value);
    outside += g.likeness == Likeness::kOutside;
  }
  const auto rate = [&](double level) {
    return 100.0 *
           static_cast<double>(std::count_if(p.begin(), p.end(), [&](double v) { return v <= level; })) /
           count;
  };
  fmt::print("{:<22} {:4} {:<6} {:6.1f} {:6.1f} {:6.1f} {:6.1f} {:8.1f}\n", name, n, cut ? "cut" : "period",
             rate(0.01), rate(0.05), rate(0.2), rate(0.5), 100.0 * outside / count);
  std::fflush(stdout);
}

}  // namespace
}  // namespace astrolith

int main(int argc, char** argv) {
  using namespace astrolith;
  CLI::App app("False alarms of the test of Gaussianity");
  int count = 200;
  app.add_option("--count", count, "textures for each row")->capture_default_str();
  CLI11_PARSE(app, argc, argv);
  const std::vector<std::pair<std::string, Shape>> shapes{
      {"white", [](double, double) { return 1.0; }},
      {"blob at 0.1",
       [](double x, double y) { return std::exp(-300.0 * (std::pow(std::abs(x) - 0.1, 2) + y * y)); }},
      {"ring at 0.2",
       [](double x, double y) { return std::exp(-2000.0 * std::pow(std::hypot(x, y) - 0.2, 2)); }},
      {"f^-3", [](double x, double y) { return std::pow(std::hypot(x, y), -3.0); }}};
  fmt::print("per cent of {} textures with p <=         1     5    20    50  outside\n", count);
  for (const auto& [name, shape] : shapes) {
    for (const int n : {64, 128, 256}) {
      for (const bool cut : {false, true}) measure(name, shape, n, cut, n == 256 ? count / 2 : count);
    }
  }
  return 0;
}
