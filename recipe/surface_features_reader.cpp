#include "recipe/surface_features_internal.h"

namespace astrolith {
namespace {

using nlohmann::json;

template <typename T>
void allow(ObjectReader& object, std::string_view name, std::optional<T>& out) {
  T value{};
  if (object.allow(name, value)) out = value;
}

void read_place(ObjectReader& object, SurfacePlace& out) {
  const bool position = object.allow("position", out.vector);
  out.is_direction = object.find("direction") != nullptr;
  if (position && out.is_direction) object.at("direction").fail("stands beside a position; leave one out");
  if (!position) object.require("direction", out.vector);
}

void read_population_fields(ObjectReader& object, Population& out) {
  allow(object, "count", out.count);
  allow(object, "density", out.density);
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
  allow(object, "depth", out.depth);
  allow(object, "rim_height", out.rim_height);
  object.allow("age", out.age);
  object.finish();
}

}  // namespace

void read_fields(ObjectReader& object, CraterLayer& out) {
  object.allow("name", out.name);
  read_profile(object, "simple", out.simple);
  read_profile(object, "complex", out.complex);
  allow(object, "complex_from", out.complex_from);
  if (const json* craters = object.find("craters")) {
    const Place place = object.at("craters");
    expect_array(*craters, place);
    out.craters.resize(craters->size());
    for (std::size_t i = 0; i < out.craters.size(); ++i) {
      read_crater((*craters)[i], place.element(i), out.craters[i]);
    }
  }
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

}  // namespace astrolith
