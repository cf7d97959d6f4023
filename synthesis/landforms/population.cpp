#include "synthesis/landforms/population.h"

#include <cmath>
#include <cstdio>

#include "numerics/errors.h"
#include "numerics/portable_double.h"

namespace astrolith {
namespace {

constexpr std::uint64_t kPopulationStream = std::uint64_t{0x706f70} << 40;  // layer and landform follow
constexpr std::uint64_t kCountOfLayer = 0xffffffffu;

CounterRandom stream_of(std::uint64_t seed, int layer_index, std::uint64_t landform) {
  return CounterRandom(seed, kPopulationStream + (static_cast<std::uint64_t>(layer_index) << 32) + landform);
}

// A Poisson number, from the exponential waiting times between events.
int poisson_number(double mean, CounterRandom random) {
  int number = 0;
  for (double waited = -portable::log(1.0 - random.uniform()); waited < mean; ++number) {
    waited -= portable::log(1.0 - random.uniform());
  }
  return number;
}

int number_of(const Population& population, const BareSurface& surface, const CounterRandom& random,
              const std::string& where) {
  if (population.count) return *population.count;
  const double mean = *population.density * surface.area();
  if (mean > 0.9 * kMaxDrawnLandforms) {  // far beyond chance
    char text[160];
    std::snprintf(
        text, sizeof text,
        ".density: would draw %.3g on this body, whose area is %.4g; at most 9e5 may be drawn: lower it",
        mean, surface.area());
    throw InputError(where + text);
  }
  return poisson_number(mean, random);
}

}  // namespace

double power_law_diameter(const Population& population, double u) {
  const double ratio = population.greatest_diameter / population.least_diameter;
  const double left_out = 1.0 - portable::pow(ratio, -population.exponent);
  return population.least_diameter * portable::pow(1.0 - u * left_out, -1.0 / population.exponent);
}

std::vector<DrawnLandform> draw_population(const Population& population, const BareSurface& surface,
                                           std::uint64_t seed, int layer_index, const std::string& where) {
  const int number = number_of(population, surface, stream_of(seed, layer_index, kCountOfLayer), where);
  std::vector<DrawnLandform> landforms(static_cast<std::size_t>(number));
  std::vector<Vec3d> random(landforms.size());
  for (std::size_t i = 0; i < landforms.size(); ++i) {
    DrawnLandform& landform = landforms[i];
    landform.random = stream_of(seed, layer_index, i);
    landform.diameter = power_law_diameter(population, landform.random.uniform());
    random[i].x = landform.random.uniform();
    random[i].y = landform.random.uniform();
    random[i].z = landform.random.uniform();
  }
  const std::vector<Vec3d> points = surface.scatter(random);
  for (std::size_t i = 0; i < points.size(); ++i) landforms[i].position = points[i];
  return landforms;
}

}  // namespace astrolith
