#include "recipe/landforms_internal.h"

namespace astrolith {
namespace {

using nlohmann::json;

void read_place(ObjectReader& object, SurfacePlace& out) {
  const bool position = object.allow("position", out.vector);
  out.is_direction = object.find("direction") != nullptr;
  if (position && out.is_direction) object.at("direction").fail("stands beside a position; leave one out");
  if (!position) object.require("direction", out.vector);
}

void read_population_fields(ObjectReader& object, Population& out) {
  object.allow("count", out.count);
  object.allow("density", out.density);
  object.require("least_diameter", out.least_diameter);
  object.require("greatest_diameter", out.greatest_diameter);
  object.allow("exponent", out.exponent);
}

void read_profile(ObjectReader& parent, std::string_view name, CraterProfile& out) {
  const json* value = parent.find(name);
  if (value == nullptr) return;
  const Place place = parent.at(name);
  ObjectReader object(*value, place);
  object.allow("depth", out.depth);
  object.allow("rim_height", out.rim_height);
  object.allow("extent", out.extent);
  object.allow("flank", out.flank);
  object.allow("sharpness", out.sharpness);
  object.allow("smoothing", out.smoothing);
  object.allow("peak_height", out.peak_height);
  object.allow("peak_radius", out.peak_radius);
  object.allow("terraces", out.terraces);
  object.finish();
}

void read_crater(const json& value, const Place& place, Crater& out) {
  ObjectReader object(value, place);
  read_place(object, out.place);
  object.require("diameter", out.diameter);
  object.allow("depth", out.depth);
  object.allow("rim_height", out.rim_height);
  object.allow("age", out.age);
  object.finish();
}

void read_boulder(const json& value, const Place& place, Boulder& out) {
  ObjectReader object(value, place);
  read_place(object, out.place);
  object.require("axes", out.axes);
  object.allow("heading", out.heading);
  object.allow("tilt", out.tilt);
  object.allow("burial", out.burial);
  object.finish();
}

template <typename T>
void read_list(ObjectReader& parent, std::string_view name, std::vector<T>& out,
               void (*read)(const json&, const Place&, T&)) {
  const json* value = parent.find(name);
  if (value == nullptr) return;
  const Place place = parent.at(name);
  expect_array(*value, place);
  out.resize(value->size());
  for (std::size_t i = 0; i < out.size(); ++i) read((*value)[i], place.element(i), out[i]);
}

}  // namespace

void read_fields(ObjectReader& object, CraterLayer& out) {
  read_profile(object, "simple", out.simple);
  read_profile(object, "complex", out.complex);
  object.allow("complex_from", out.complex_from);
  read_list(object, "craters", out.craters, read_crater);
  if (const json* value = object.find("population")) {
    const Place place = object.at("population");
    ObjectReader population(*value, place);
    CraterPopulation& drawn = out.population.emplace();
    read_population_fields(population, drawn.drawn);
    population.allow("greatest_age", drawn.greatest_age);
    population.allow("depth_spread", drawn.depth_spread);
    population.allow("degradation", drawn.degradation);
    population.finish();
  }
}

void read_fields(ObjectReader& object, BoulderLayer& out) {
  object.allow("smoothing", out.smoothing);
  object.allow("roughness", out.roughness);
  read_list(object, "boulders", out.boulders, read_boulder);
  if (const json* value = object.find("population")) {
    const Place place = object.at("population");
    ObjectReader population(*value, place);
    BoulderPopulation& drawn = out.population.emplace();
    read_population_fields(population, drawn.drawn);
    population.allow("axis_ratios", drawn.axis_ratios);
    population.allow("ratio_spread", drawn.ratio_spread);
    population.allow("least_burial", drawn.least_burial);
    population.allow("greatest_burial", drawn.greatest_burial);
    population.allow("greatest_tilt", drawn.greatest_tilt);
    population.finish();
  }
}

}  // namespace astrolith
