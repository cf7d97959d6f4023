// Lists of fields of a recipe's craters and boulders, with their rules.
#include <fmt/format.h>

#include <algorithm>

#include "recipe/fields_internal.h"

namespace astrolith {
namespace {

// A place is either the field `position` or the field `direction`.
void visit_place(FieldVisitor& v, SurfacePlace& place) {
  std::optional<Vec3d> position, direction;
  if (!v.reading()) (place.is_direction ? direction : position) = place.vector;
  v.field("position", position, kAnyNumber);
  if (position) {
    v.field("direction", direction, kAnyNumber);
  } else {
    v.required("direction", direction, kAnyNumber);
  }
  const Place at = v.place().field("direction");
  if (v.reading() && position && direction) at.fail("stands beside a position; leave one out");
  if (v.checking() && direction && !(norm(*direction) > 0.0)) at.fail("must not be [0, 0, 0]");
  if (v.reading()) place = {position ? *position : direction.value_or(Vec3d{}), direction.has_value()};
}

void check_number(const Population& population, const Place& place) {
  if (population.count.has_value() != population.density.has_value()) return;
  place.field("count").fail(population.count ? "stands beside a density; leave one out"
                                             : "is missing; give a count or a density");
}

void check_diameters(const Population& population, const Place& place) {
  if (population.greatest_diameter >= population.least_diameter) return;
  place.field("greatest_diameter")
      .fail(fmt::format("is {}, below least_diameter; raise it", population.greatest_diameter));
}

void check_cells(const Population& population, const Place& place) {
  if (!population.by_cells) return;
  const char* const other = population.count ? "count" : population.clusters ? "clusters" : nullptr;
  if (other == nullptr) return;
  place.field("by_cells")
      .fail(fmt::format("a population drawn by cells has no {}; {}", other,
                        population.count ? "give its density" : "leave one of both out"));
}

void visit_population(FieldVisitor& v, Population& population) {
  v.rule(check_number, population);
  v.field("count", population.count, range(0, kMaxDrawnLandforms));
  v.field("density", population.density, kNotNegative);
  v.required("least_diameter", population.least_diameter, kPositive);
  v.required("greatest_diameter", population.greatest_diameter, kPositive);
  v.rule(check_diameters, population);
  v.field("exponent", population.exponent, range(0.01, 10.0));
  v.field("weibull", population.weibull);
  v.field("clusters", population.clusters);
  v.field("locality", population.locality);
  v.field("mask", population.mask);
  v.field_if(population.by_cells, "by_cells", population.by_cells);
  v.rule(check_cells, population);
}

void check_axes(const Boulder& boulder, const Place& place) {
  const auto [shortest, longest] = std::minmax({boulder.axes.x, boulder.axes.y, boulder.axes.z});
  if (shortest >= kMinAxisRatio * longest) return;
  place.field("axes").fail(
      fmt::format("the shortest must be at least {:g} of the longest; bring them closer", kMinAxisRatio));
}

void check_burials(const BoulderPopulation& population, const Place& place) {
  if (population.greatest_burial >= population.least_burial) return;
  place.field("greatest_burial")
      .fail(fmt::format("is {}, below least_burial; raise it", population.greatest_burial));
}

}  // namespace

void visit_fields(FieldVisitor& v, CraterProfile& profile) {
  v.field("depth", profile.depth, kShare);
  v.field("rim_height", profile.rim_height, kShare);
  v.field("extent", profile.extent, range(1.05, 10.0));
  v.field("flank", profile.flank, range(1.0, 8.0));
  v.field("sharpness", profile.sharpness, range(1.0, 100.0));
  v.field("smoothing", profile.smoothing, kShare);
  v.field("peak_height", profile.peak_height, kShare);
  v.field("peak_radius", profile.peak_radius, range(0.01, 1.0));
  v.field("terraces", profile.terraces, range(0, 16));
}

void visit_fields(FieldVisitor& v, Crater& crater) {
  visit_place(v, crater.place);
  v.required("diameter", crater.diameter, kPositive);
  v.field("depth", crater.depth, range(0.0, crater.diameter));
  v.field("rim_height", crater.rim_height, range(0.0, crater.diameter));
  v.field("age", crater.age, kNotNegative);
}

void visit_fields(FieldVisitor& v, WeibullSizes& sizes) {
  v.required("scale", sizes.scale, kPositive);
  v.required("shape", sizes.shape, range(0.05, 10.0));
}

void visit_fields(FieldVisitor& v, Clusters& clusters) {
  v.required("number", clusters.number, range(1, kMaxClusters));
  v.required("radius", clusters.radius, kPositive);
  v.field("share", clusters.share, kShare);
}

void visit_fields(FieldVisitor& v, CraterPopulation& population) {
  visit_population(v, population.drawn);
  v.field("greatest_age", population.greatest_age, kNotNegative);
  v.field("depth_spread", population.depth_spread, kShare);
  v.field("degradation", population.degradation, kShare);
  v.field_if(population.depth_deviation != 0.0, "depth_deviation", population.depth_deviation, kShare);
}

void visit_fields(FieldVisitor& v, CraterLayer& layer) {
  v.field("simple", layer.simple);
  v.field("complex", layer.complex);
  v.field("complex_from", layer.complex_from, kPositive);
  v.field("craters", layer.craters);
  v.field("population", layer.population);
  v.field("albedo", layer.albedo);
}

void visit_fields(FieldVisitor& v, Boulder& boulder) {
  visit_place(v, boulder.place);
  v.required("axes", boulder.axes, kPositive);
  v.rule(check_axes, boulder);
  v.field("heading", boulder.heading, range(-360.0, 360.0));
  v.field("tilt", boulder.tilt, range(-180.0, 180.0));
  v.field("burial", boulder.burial, kShare);
}

void visit_fields(FieldVisitor& v, BoulderPopulation& population) {
  visit_population(v, population.drawn);
  v.field("axis_ratios", population.axis_ratios, range(kMinAxisRatio, 1.0));
  v.field("ratio_spread", population.ratio_spread, range(0.0, 0.9));
  v.field("least_burial", population.least_burial, kShare);
  v.field("greatest_burial", population.greatest_burial, kShare);
  v.rule(check_burials, population);
  v.field("greatest_tilt", population.greatest_tilt, range(0.0, 90.0));
}

void visit_fields(FieldVisitor& v, LocalGravity& gravity) {
  const bool at_rest = gravity.rotation_period == 0.0;
  v.field("density", gravity.density, range(1.0, 30000.0));
  v.field("rotation_period", gravity.rotation_period, at_rest ? kNotNegative : range(0.01, 1e6));
}

void visit_fields(FieldVisitor& v, BoulderLayer& layer) {
  v.field("smoothing", layer.smoothing, kShare);
  v.field("roughness", layer.roughness, range(0.0, 0.5));
  v.field("angularity", layer.angularity, range(0.0, 1.0));
  v.field("boulders", layer.boulders);
  v.field("population", layer.population);
  v.field("gravity", layer.gravity);
  v.field("albedo", layer.albedo);
}

}  // namespace astrolith
