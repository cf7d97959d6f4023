#include "recipe/noise_layers_internal.h"

namespace astrolith {
namespace {

using nlohmann::json;

void read_kind(ObjectReader& object, Combine& out) {
  std::string word;
  object.require("type", word);
  for (const Combine combine : kCombines) {
    if (word == combine_word(combine)) {
      out = combine;
      return;
    }
  }
  object.at("type").fail("must be \"add\", \"replace\", \"blend\", \"warp\" or \"mask\", is " +
                         quote_text(word));
}

void read_blend_operator(ObjectReader& object, bool& intersection) {
  std::string word = "union";
  object.allow("operator", word);
  intersection = word == "intersection";
  if (!intersection && word != "union") {
    object.at("operator").fail("must be \"union\" or \"intersection\", is " + quote_text(word));
  }
}

void read_combination(const json& value, const Place& place, Combination& out) {
  ObjectReader object(value, place);
  read_kind(object, out.kind);
  if (out.kind == Combine::kBlend) {
    read_blend_operator(object, out.intersection);
    object.allow("width", out.width);
  } else if (out.kind == Combine::kWarp) {
    object.require("direction", out.direction);
  }
  object.finish();
}

}  // namespace

void read_use(ObjectReader& layer, LayerUse& out) {
  if (const json* value = layer.find("locality")) {
    const Place place = layer.at("locality");
    ObjectReader object(*value, place);
    Locality& locality = out.locality.emplace();
    object.require("group", locality.group);
    object.require("width", locality.width);
    object.finish();
  }
  if (const json* value = layer.find("mask")) {
    const Place place = layer.at("mask");
    ObjectReader object(*value, place);
    LayerMask& mask = out.mask.emplace();
    object.require("layer", mask.layer);
    object.require("from", mask.from);
    object.require("to", mask.to);
    object.finish();
  }
  if (const json* value = layer.find("combine")) {
    read_combination(*value, layer.at("combine"), out.combination);
  }
}

}  // namespace astrolith
