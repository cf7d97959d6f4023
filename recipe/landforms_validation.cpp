#include <algorithm>

#include "recipe/expect_internal.h"
#include "recipe/landforms_internal.h"

namespace astrolith {
namespace {

void check(const SurfacePlace& place, const Place& at) {
  expect_vector(place.vector, at.field(place.is_direction ? "direction" : "position"));
  if (place.is_direction && !(norm(place.vector) > 0.0)) at.field("direction").fail("must not be [0, 0, 0]");
}

void check(const Population& population, const Place& place) {
  if (population.count.has_value() == population.density.has_value()) {
    place.field("count").fail(population.count ? "stands beside a density; leave one out"
                                               : "is missing; give a count or a density");
  }
  if (population.count) expect_integer(*population.count, place.field("count"), 0, kMaxDrawnFeatures);
  if (population.density) expect_not_negative(*population.density, place.field("density"));
  expect_positive(population.least_diameter, place.field("least_diameter"));
  expect_positive(population.greatest_diameter, place.field("greatest_diameter"));
  if (population.greatest_diameter < population.least_diameter) {
    place.field("greatest_diameter")
        .fail(fmt::format("is {}, below least_diameter; raise it", population.greatest_diameter));
  }
  expect_range(population.exponent, place.field("exponent"), 0.01, 10.0);
}

void check(const CraterProfile& profile, const Place& place) {
  expect_range(profile.depth, place.field("depth"), 0.0, 1.0);
  expect_range(profile.rim_height, place.field("rim_height"), 0.0, 1.0);
  expect_range(profile.extent, place.field("extent"), 1.05, 10.0);
  expect_range(profile.flank, place.field("flank"), 1.0, 8.0);
  expect_range(profile.sharpness, place.field("sharpness"), 1.0, 100.0);
  expect_range(profile.smoothing, place.field("smoothing"), 0.0, 1.0);
  expect_range(profile.peak_height, place.field("peak_height"), 0.0, 1.0);
  expect_range(profile.peak_radius, place.field("peak_radius"), 0.01, 1.0);
  expect_integer(profile.terraces, place.field("terraces"), 0, 16);
}

void check(const Crater& crater, const Place& place) {
  check(crater.place, place);
  expect_positive(crater.diameter, place.field("diameter"));
  if (crater.depth) expect_range(*crater.depth, place.field("depth"), 0.0, crater.diameter);
  if (crater.rim_height) expect_range(*crater.rim_height, place.field("rim_height"), 0.0, crater.diameter);
  expect_not_negative(crater.age, place.field("age"));
}

void check(const Boulder& boulder, const Place& place) {
  check(boulder.place, place);
  const Place axes = place.field("axes");
  expect_positive(boulder.axes.x, axes.field("x"));
  expect_positive(boulder.axes.y, axes.field("y"));
  expect_positive(boulder.axes.z, axes.field("z"));
  const double longest = std::max({boulder.axes.x, boulder.axes.y, boulder.axes.z});
  if (std::min({boulder.axes.x, boulder.axes.y, boulder.axes.z}) < kMinAxisRatio * longest) {
    axes.fail(
        fmt::format("the shortest must be at least {:g} of the longest; bring them closer", kMinAxisRatio));
  }
  expect_range(boulder.heading, place.field("heading"), -360.0, 360.0);
  expect_range(boulder.tilt, place.field("tilt"), -180.0, 180.0);
  expect_range(boulder.burial, place.field("burial"), 0.0, 1.0);
}

void check(const BoulderPopulation& population, const Place& place) {
  check(population.drawn, place);
  const Place ratios = place.field("axis_ratios");
  expect_range(population.axis_ratios.x, ratios.field("x"), kMinAxisRatio, 1.0);
  expect_range(population.axis_ratios.y, ratios.field("y"), kMinAxisRatio, 1.0);
  expect_range(population.axis_ratios.z, ratios.field("z"), kMinAxisRatio, 1.0);
  expect_range(population.ratio_spread, place.field("ratio_spread"), 0.0, 0.9);
  expect_range(population.least_burial, place.field("least_burial"), 0.0, 1.0);
  expect_range(population.greatest_burial, place.field("greatest_burial"), 0.0, 1.0);
  if (population.greatest_burial < population.least_burial) {
    place.field("greatest_burial")
        .fail(fmt::format("is {}, below least_burial; raise it", population.greatest_burial));
  }
  expect_range(population.greatest_tilt, place.field("greatest_tilt"), 0.0, 90.0);
}

}  // namespace

void check(const CraterLayer& layer, const Place& place) {
  check(layer.simple, place.field("simple"));
  check(layer.complex, place.field("complex"));
  if (layer.complex_from) expect_positive(*layer.complex_from, place.field("complex_from"));
  const Place craters = place.field("craters");
  for (std::size_t i = 0; i < layer.craters.size(); ++i) check(layer.craters[i], craters.element(i));
  if (!layer.population) return;
  const Place population = place.field("population");
  check(layer.population->drawn, population);
  expect_not_negative(layer.population->greatest_age, population.field("greatest_age"));
  expect_range(layer.population->depth_spread, population.field("depth_spread"), 0.0, 1.0);
  expect_range(layer.population->degradation, population.field("degradation"), 0.0, 1.0);
}

void check(const BoulderLayer& layer, const Place& place) {
  expect_range(layer.smoothing, place.field("smoothing"), 0.0, 1.0);
  expect_range(layer.roughness, place.field("roughness"), 0.0, 0.5);
  const Place boulders = place.field("boulders");
  for (std::size_t i = 0; i < layer.boulders.size(); ++i) check(layer.boulders[i], boulders.element(i));
  if (layer.population) check(*layer.population, place.field("population"));
}

}  // namespace astrolith
