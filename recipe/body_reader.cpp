#include <fmt/format.h>

#include <algorithm>

#include "recipe/body_internal.h"

namespace astrolith {
namespace {

using nlohmann::json;

void read_sphere(const json& value, const Place& place, Sphere& out) {
  expect_row(value, place, {"x", "y", "z", "radius"});
  read_value(value[0], place.field("x"), out.center.x);
  read_value(value[1], place.field("y"), out.center.y);
  read_value(value[2], place.field("z"), out.center.z);
  read_value(value[3], place.field("radius"), out.radius);
}

// A field that must have one of a few words.
void expect_word(const std::string& word, const Place& place, std::string_view wanted) {
  if (word != wanted) place.fail(fmt::format("must be \"{}\", is {}", wanted, quote_text(word)));
}

void read_kernel(ObjectReader& object, Kernel& out) {
  std::string word(kernel_word(out));
  object.allow("kernel", word);
  for (const Kernel kernel : kKernels) {
    if (word == kernel_word(kernel)) {
      out = kernel;
      return;
    }
  }
  object.at("kernel").fail(
      "must be \"gaussian\", \"metaball\", \"soft_object\", \"wyvill\" or \"cauchy\", is " +
      quote_text(word));
}

void read_groups(const json& value, const Place& place, std::vector<SphereGroup>& out) {
  ObjectReader object(value, place);  // any names
  for (const auto& [name, spheres] : value.items()) {
    out.push_back({name, {}});
    read_elements(spheres, place.field(name), out.back().spheres, read_value);
  }
  std::sort(out.begin(), out.end(),
            [](const SphereGroup& a, const SphereGroup& b) { return a.name < b.name; });
}

void read_operator(ObjectReader& object, Operator& out) {
  std::string word;
  object.require("type", word);
  for (const Operator op : kOperators) {
    if (word == operator_word(op)) {
      out = op;
      return;
    }
  }
  object.at("type").fail(
      "must be \"union\", \"intersection\", \"difference\", \"blend\" or \"clean_union\", is " +
      quote_text(word));
}

void read_operation(const json& value, const Place& place, BodyOperation& out) {
  ObjectReader object(value, place);
  read_operator(object, out.kind);
  if (out.kind == Operator::kBlend) {
    object.require("width", out.width);
    object.allow("exponent", out.exponent);
  } else if (out.kind == Operator::kCleanUnion) {
    object.allow("bulge", out.bulge);
    if (const json* row = object.find("reach")) {
      expect_row(*row, object.at("reach"), {"a1", "a2"});
      read_value((*row)[0], object.at("reach").field("a1"), out.reach[0]);
      read_value((*row)[1], object.at("reach").field("a2"), out.reach[1]);
    }
  } else {
    object.allow("alpha", out.alpha);
  }
  if (const json* body = object.find("body")) {
    read_body(*body, object.at("body"), out.operand.emplace_back());
  } else {
    object.note_missing("body");
  }
  object.finish();
}

}  // namespace

void read_warp(ObjectReader& parent, std::optional<Warp>& out) {
  const json* value = parent.find("warp");
  if (value == nullptr) return;
  const Place place = parent.at("warp");
  ObjectReader object(*value, place);
  Warp& warp = out.emplace();
  object.require("amplitude", warp.amplitude);
  object.require("frequency", warp.frequency);
  object.allow("octaves", warp.octaves);
  object.allow("gain", warp.gain);
  object.allow("lacunarity", warp.lacunarity);
  object.finish();
}

void read_body(const json& value, const Place& place, MetaballBody& out) {
  ObjectReader object(value, place);
  std::string type = "metaballs";
  object.require("type", type);
  expect_word(type, object.at("type"), "metaballs");
  read_kernel(object, out.kernel);
  object.allow("a", out.a);
  object.allow("b", out.b);
  object.allow("blend_exponent", out.blend_exponent);
  object.allow("iso_value", out.iso_value);
  object.allow("cutoff_radii", out.cutoff_radii);
  require_elements(object, "spheres", out.spheres, read_sphere);
  if (const json* list = object.find("subtract")) {
    read_elements(*list, object.at("subtract"), out.subtract, read_sphere);
  }
  if (const json* groups = object.find("groups")) read_groups(*groups, object.at("groups"), out.groups);
  read_warp(object, out.warp);
  if (const json* list = object.find("operations")) {
    read_elements(*list, object.at("operations"), out.operations, read_operation);
  }
  object.finish();
}

}  // namespace astrolith
