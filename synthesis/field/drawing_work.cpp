#include "synthesis/field/drawing_work.h"

#include <cmath>

#include "numerics/errors.h"
#include "synthesis/field/noise_facts.h"

namespace astrolith {
namespace {

// A point takes about 0.1 ms where the spots of all layers take as many draws.
constexpr double kMostSpotDraws = 8192.0;
// A point far from all others takes about 0.1 ms where the Gabor layers take as many draws.
constexpr double kMostGaborDraws = 65536.0;

void expect_few_draws(const std::string& what, double draws, double most, const std::string& remedy) {
  if (draws <= most) return;
  const auto whole_number = [](double v) { return std::to_string(std::llround(v)); };
  throw InputError(what + ", with those of earlier layers, take " + whole_number(draws) +
                   " random draws at each point, at most " + whole_number(most) + " are allowed; " + remedy);
}

}  // namespace

void DrawingWork::add(const LayerNoise& noise, const ArrayView& arrays, const std::string& place) {
  switch (traits_of(noise).lists) {
    case NoiseLists::kSpots:
      spot_draws_ += draws_at_a_point(noise, arrays);
      return expect_few_draws(place + ".density: these spots", spot_draws_, kMostSpotDraws,
                              "lower density, layers or size, or use larger cells or fewer parts");
    case NoiseLists::kGabor:
      gabor_draws_ += draws_at_a_point(noise, arrays);
      return expect_few_draws(place + ".impulses_per_kernel: these impulses", gabor_draws_, kMostGaborDraws,
                              "lower impulses_per_kernel, or use lobes of fewer bandwidths");
    case NoiseLists::kNone:
    case NoiseLists::kCraters:
      return;
  }
}

}  // namespace astrolith
