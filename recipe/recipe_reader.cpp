#include <fmt/format.h>

#include <algorithm>

#include "numerics/errors.h"
#include "recipe/json_document_internal.h"
#include "recipe/object_reader_internal.h"
#include "recipe/recipe_json.h"
#include "recipe/surface_features_internal.h"

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

template <typename T>
using ReadElement = void (*)(const json&, const Place&, T&);

template <typename T>
void read_elements(const json& value, const Place& place, std::vector<T>& out, ReadElement<T> read_element) {
  expect_array(value, place);
  out.resize(value.size());
  for (std::size_t i = 0; i < out.size(); ++i) read_element(value[i], place.element(i), out[i]);
}

void read_sphere(const json& value, const Place& place, Sphere& out) {
  expect_row(value, place, {"x", "y", "z", "radius"});
  read_value(value[0], place.field("x"), out.center.x);
  read_value(value[1], place.field("y"), out.center.y);
  read_value(value[2], place.field("z"), out.center.z);
  read_value(value[3], place.field("radius"), out.radius);
}

void read_lobe(const json& value, const Place& place, GaborLobe& out) {
  expect_row(value, place, {"bandwidth", "frequency_x", "frequency_y", "variance"});
  read_value(value[0], place.field("bandwidth"), out.bandwidth);
  read_value(value[1], place.field("frequency_x"), out.frequency_x);
  read_value(value[2], place.field("frequency_y"), out.frequency_y);
  read_value(value[3], place.field("variance"), out.variance);
}

template <typename T>
void require_elements(ObjectReader& object, std::string_view name, std::vector<T>& out,
                      ReadElement<T> read_element) {
  if (const json* value = object.find(name)) return read_elements(*value, object.at(name), out, read_element);
  object.note_missing(name);
}

// A field that must have one of a few words.
void expect_word(const std::string& word, const Place& place, std::string_view wanted) {
  if (word != wanted) place.fail(fmt::format("must be \"{}\", is {}", wanted, quote_text(word)));
}

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

// The fields that every kind of layer has.
void read_use(ObjectReader& layer, LayerUse& out) {
  if (const json* value = layer.find("locality")) {
    const Place place = layer.at("locality");
    ObjectReader object(*value, place);
    Locality& locality = out.locality.emplace();
    object.require("group", locality.group);
    object.require("width", locality.width);
    object.finish();
  }
}

void read_body(const json& value, const Place& place, MetaballBody& out);

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
  if (const json* groups = object.find("groups")) read_groups(*groups, object.at("groups"), out.groups);
  read_warp(object, out.warp);
  if (const json* list = object.find("operations")) {
    read_elements(*list, object.at("operations"), out.operations, read_operation);
  }
  object.finish();
}

// What a Worley layer's field "distance" says, and the noise it means.
constexpr std::pair<std::string_view, Noise> kWorleyDistances[] = {
    {"f1", Noise::kWorleyF1}, {"f2", Noise::kWorleyF2}, {"f2-f1", Noise::kWorleyF2MinusF1}};

void read_worley_distance(ObjectReader& object, Noise& out) {
  std::string word = "f1";
  object.allow("distance", word);
  for (const auto& [name, noise] : kWorleyDistances) {
    if (word == name) {
      out = noise;
      return;
    }
  }
  object.at("distance").fail("must be \"f1\", \"f2\" or \"f2-f1\", is " + quote_text(word));
}

void read_fields(ObjectReader& object, FractalLayer& out) {
  if (is_worley(out.noise)) {
    read_worley_distance(object, out.noise);
  } else {
    object.allow("gradient_modulation", out.gradient_modulation);
  }
  object.allow("name", out.name);
  object.allow("amplitude", out.amplitude);
  object.allow("frequency", out.frequency);
  object.allow("octaves", out.octaves);
  object.allow("gain", out.gain);
  object.allow("lacunarity", out.lacunarity);
  object.allow("scale", out.scale);
  object.allow("bias", out.bias);
  object.allow("weight", out.weight);
  read_warp(object, out.warp);
}

void read_color(const json& value, const Place& place, LayerColor& out) {
  ObjectReader object(value, place);
  object.require("axis", out.axis);
  object.allow("mean", out.mean);
  object.finish();
}

void read_fields(ObjectReader& object, GaborLayer& out) {
  object.allow("name", out.name);
  object.allow("pixel_size", out.pixel_size);
  object.allow("height_rms", out.height_rms);
  object.allow("impulses_per_kernel", out.impulses_per_kernel);
  object.allow("exemplar_mean", out.exemplar_mean);
  object.allow("exemplar_rms", out.exemplar_rms);
  if (const json* color = object.find("color")) read_color(*color, object.at("color"), out.color.emplace());
  require_elements(object, "lobes", out.lobes, read_lobe);
}

void read_fields(ObjectReader& object, SpotLayer& out) {
  object.allow("name", out.name);
  object.allow("amplitude", out.amplitude);
  object.allow("inverted", out.inverted);
  object.allow("size", out.size);
  object.allow("cell_size", out.cell_size);
  object.allow("density", out.density);
  object.allow("probability", out.probability);
  object.allow("reach", out.reach);
  object.allow("least_weight", out.least_weight);
  object.allow("gaussian", out.gaussian);
  object.allow("alpha", out.alpha);
  object.allow("kappa", out.kappa);
  object.allow("beta", out.beta);
  object.allow("gamma", out.gamma);
  object.allow("variances", out.variances);
  object.allow("sigma", out.sigma);
  object.allow("layers", out.layers);
  object.allow("lacunarity", out.lacunarity);
  object.allow("gain", out.gain);
  object.allow("exponent", out.exponent);
}

void read_fields(ObjectReader& object, SparseLayer& out) {
  object.allow("name", out.name);
  object.allow("amplitude", out.amplitude);
  object.allow("cell_size", out.cell_size);
  object.allow("levels", out.levels);
  object.allow("probability", out.probability);
  object.allow("threshold", out.threshold);
  object.allow("gain", out.gain);
  object.allow("merged", out.merged);
}

void read_fields(ObjectReader& object, RandomPhaseLayer& out) {
  object.allow("name", out.name);
  object.allow("height_rms", out.height_rms);
  object.allow("cell_size", out.cell_size);
  object.allow("waves", out.waves);
  object.allow("frequency_min", out.frequency_min);
  object.allow("frequency_max", out.frequency_max);
  object.allow("exponent", out.exponent);
  object.allow("direction", out.direction);
  object.allow("spread", out.spread);
  object.allow("randomness", out.randomness);
}

void read_profile(ObjectReader& object, PhasorProfile& out) {
  std::string word(profile_word(out));
  object.allow("profile", word);
  for (const PhasorProfile profile : kPhasorProfiles) {
    if (word == profile_word(profile)) {
      out = profile;
      return;
    }
  }
  object.at("profile").fail("must be \"sine\", \"triangle\", \"sawtooth\" or \"square\", is " +
                            quote_text(word));
}

void read_fields(ObjectReader& object, PhasorLayer& out) {
  object.allow("name", out.name);
  object.allow("amplitude", out.amplitude);
  object.allow("frequency", out.frequency);
  object.allow("cell_size", out.cell_size);
  object.allow("impulses_per_cell", out.impulses_per_cell);
  object.allow("direction", out.direction);
  object.allow("spread", out.spread);
  read_profile(object, out.profile);
}

constexpr const char* kLayerTypes =
    "\"simplex\", \"perlin\", \"worley\", \"spots\", \"sparse\", \"craters\", \"boulders\", "
    "\"random_phase\", "
    "\"phasor\" and \"gabor\"";

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
