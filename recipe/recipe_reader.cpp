#include <fmt/format.h>

#include <algorithm>

#include "numerics/errors.h"
#include "recipe/body_internal.h"
#include "recipe/json_document_internal.h"
#include "recipe/landforms_internal.h"
#include "recipe/noise_layers_internal.h"
#include "recipe/recipe_json.h"

namespace astrolith {
namespace {

using nlohmann::json;

template <typename T>
void read_named(const json& value, const Place& place, std::vector<std::pair<std::string, T>>& out) {
  ObjectReader object(value, place);  // any names
  for (const auto& [name, member] : value.items()) {
    out.emplace_back(name, T{});
    read_value(member, place.field(name), out.back().second);
  }
  std::sort(out.begin(), out.end());
}

constexpr const char* kLayerTypes =
    "\"simplex\", \"perlin\", \"worley\", \"spots\", \"sparse\", \"craters\", \"boulders\", "
    "\"random_phase\", "
    "\"phasor\" and \"gabor\"";

// What all kinds of layer have.
void read_identity(ObjectReader& object, auto& layer) {
  object.allow("name", layer.name);
  object.allow("seed", layer.seed);
}

void read_layer(const json& value, const Place& place, Layer& out) {
  ObjectReader object(value, place);
  std::string type;
  const auto read_fractal = [&](Noise noise) {
    FractalLayer& layer = out.emplace<FractalLayer>();
    layer.noise = noise;
    read_fields(object, layer);
  };
  if (!object.allow("type", type))
    object.at("type").fail(std::string("is missing; add one of ") + kLayerTypes);
  if (type == "simplex") {
    read_fractal(Noise::kSimplex);
  } else if (type == "perlin") {
    read_fractal(Noise::kPerlin);
  } else if (type == "worley") {
    read_fractal(Noise::kWorleyF1);
  } else if (type == "spots") {
    read_fields(object, out.emplace<SpotLayer>());
  } else if (type == "sparse") {
    read_fields(object, out.emplace<SparseLayer>());
  } else if (type == "craters") {
    read_fields(object, out.emplace<CraterLayer>());
  } else if (type == "boulders") {
    read_fields(object, out.emplace<BoulderLayer>());
  } else if (type == "random_phase") {
    read_fields(object, out.emplace<RandomPhaseLayer>());
  } else if (type == "phasor") {
    read_fields(object, out.emplace<PhasorLayer>());
  } else if (type == "gabor") {
    read_fields(object, out.emplace<GaborLayer>());
  } else {
    object.at("type").fail(std::string("must be one of ") + kLayerTypes + ", is " + quote_text(type));
  }
  std::visit([&](auto& layer) { read_identity(object, layer); }, out);
  if (LayerUse* use = use_of(out)) read_use(object, *use);
  object.finish();
}

void read_erosion(const json& value, const Place& place, Erosion& out) {
  ObjectReader object(value, place);
  object.require("talus_angle", out.talus_angle);
  object.allow("iterations", out.iterations);
  object.allow("density", out.density);
  object.allow("rotation_period", out.rotation_period);
  object.finish();
}

void read_provenance(const json& value, const Place& place, Provenance& out) {
  ObjectReader object(value, place);
  object.allow("tool", out.tool);
  object.allow("input_name", out.input_name);
  object.allow("input_sha256", out.input_sha256);
  if (const json* options = object.find("options")) read_named(*options, object.at("options"), out.options);
  if (const json* figures = object.find("achieved"))
    read_named(*figures, object.at("achieved"), out.achieved);
  object.finish();
}

// Before anything else: fields of another version would only be reported as unknown.
void read_version(const json& document, const Place& place, int& out) {
  ObjectReader object(document, place);
  if (!object.allow("format_version", out)) {
    object.at("format_version").fail(fmt::format("is missing; add {}", kRecipeFormatVersion));
  }
  if (out != kRecipeFormatVersion) {
    object.at("format_version")
        .fail(fmt::format("is {}, this program reads {}; use the program version that wrote the file", out,
                          kRecipeFormatVersion));
  }
}

Recipe read_document(const json& document, const Place& place) {
  Recipe recipe;
  read_version(document, place, recipe.format_version);
  ObjectReader object(document, place);
  object.find("format_version");
  object.allow("description", recipe.description);
  object.require("length_unit", recipe.length_unit);
  object.allow("frame", recipe.frame);
  object.allow("seed", recipe.seed);
  if (const json* from = object.find("provenance"))
    read_provenance(*from, object.at("provenance"), recipe.provenance);
  if (const json* body = object.find("body")) read_body(*body, object.at("body"), recipe.body.emplace());
  if (const json* layers = object.find("layers"))
    read_elements(*layers, object.at("layers"), recipe.layers, read_layer);
  if (const json* erosion = object.find("erosion"))
    read_erosion(*erosion, object.at("erosion"), recipe.erosion.emplace());
  object.finish();
  return recipe;
}

}  // namespace

Recipe parse_recipe(std::string_view text, const std::string& name) {
  const json document = parse_json(text, name);
  Recipe recipe = read_document(document, Place(name));
  validate_recipe(recipe, name);
  return recipe;
}

Recipe read_recipe(const std::filesystem::path& file) {
  return parse_recipe(read_json_text(file), file.string());
}

}  // namespace astrolith
