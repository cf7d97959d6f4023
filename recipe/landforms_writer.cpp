#include "recipe/body_internal.h"
#include "recipe/landforms_internal.h"

namespace astrolith {
namespace {

using nlohmann::ordered_json;

void write_place(const SurfacePlace& place, ordered_json& object) {
  object[place.is_direction ? "direction" : "position"] = to_json(place.vector);
}

ordered_json to_json(const Population& population) {
  ordered_json object = ordered_json::object();
  if (population.count) object["count"] = *population.count;
  if (population.density) object["density"] = *population.density;
  object["least_diameter"] = population.least_diameter;
  object["greatest_diameter"] = population.greatest_diameter;
  object["exponent"] = population.exponent;
  return object;
}

ordered_json to_json(const CraterProfile& profile) {
  return {{"depth", profile.depth},
          {"rim_height", profile.rim_height},
          {"extent", profile.extent},
          {"flank", profile.flank},
          {"sharpness", profile.sharpness},
          {"smoothing", profile.smoothing},
          {"peak_height", profile.peak_height},
          {"peak_radius", profile.peak_radius},
          {"terraces", profile.terraces}};
}

ordered_json to_json(const Crater& crater) {
  ordered_json object = ordered_json::object();
  write_place(crater.place, object);
  object["diameter"] = crater.diameter;
  if (crater.depth) object["depth"] = *crater.depth;
  if (crater.rim_height) object["rim_height"] = *crater.rim_height;
  object["age"] = crater.age;
  return object;
}

ordered_json to_json(const Boulder& boulder) {
  ordered_json object = ordered_json::object();
  write_place(boulder.place, object);
  object["axes"] = to_json(boulder.axes);
  object["heading"] = boulder.heading;
  object["tilt"] = boulder.tilt;
  object["burial"] = boulder.burial;
  return object;
}

ordered_json to_json(const BoulderPopulation& population) {
  ordered_json object = to_json(population.drawn);
  object["axis_ratios"] = to_json(population.axis_ratios);
  object["ratio_spread"] = population.ratio_spread;
  object["least_burial"] = population.least_burial;
  object["greatest_burial"] = population.greatest_burial;
  object["greatest_tilt"] = population.greatest_tilt;
  return object;
}

}  // namespace

ordered_json to_json(const CraterLayer& layer) {
  ordered_json object{{"type", "craters"}, {"name", layer.name}};
  object["simple"] = to_json(layer.simple);
  object["complex"] = to_json(layer.complex);
  if (layer.complex_from) object["complex_from"] = *layer.complex_from;
  object["craters"] = ordered_json::array();
  for (const Crater& crater : layer.craters) object["craters"].push_back(to_json(crater));
  if (layer.population) {
    object["population"] = to_json(layer.population->drawn);
    object["population"]["greatest_age"] = layer.population->greatest_age;
    object["population"]["depth_spread"] = layer.population->depth_spread;
    object["population"]["degradation"] = layer.population->degradation;
  }
  return object;
}

ordered_json to_json(const BoulderLayer& layer) {
  ordered_json object{{"type", "boulders"},
                      {"name", layer.name},
                      {"smoothing", layer.smoothing},
                      {"roughness", layer.roughness}};
  object["boulders"] = ordered_json::array();
  for (const Boulder& boulder : layer.boulders) object["boulders"].push_back(to_json(boulder));
  if (layer.population) object["population"] = to_json(*layer.population);
  return object;
}

}  // namespace astrolith
