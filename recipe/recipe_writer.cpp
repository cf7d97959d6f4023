#include <algorithm>
#include <charconv>
#include <cmath>
#include <nlohmann/json.hpp>

#include "numerics/errors.h"
#include "numerics/output_file.h"
#include "recipe/recipe_json.h"
#include "recipe/surface_features_internal.h"

namespace astrolith {
namespace {

using nlohmann::ordered_json;

ordered_json to_json(const Vec3d& v) { return {v.x, v.y, v.z}; }

ordered_json to_json(const Warp& warp) {
  return {{"amplitude", warp.amplitude},
          {"frequency", warp.frequency},
          {"octaves", warp.octaves},
          {"gain", warp.gain},
          {"lacunarity", warp.lacunarity}};
}

ordered_json to_json(const MetaballBody& body);

ordered_json to_json(const BodyOperation& operation) {
  ordered_json object{{"type", operator_word(operation.kind)}};
  if (operation.kind == Operator::kBlend) {
    object["width"] = operation.width;
    object["exponent"] = operation.exponent;
  } else if (operation.kind == Operator::kCleanUnion) {
    object["bulge"] = operation.bulge;
    object["reach"] = {operation.reach[0], operation.reach[1]};
  } else {
    object["alpha"] = operation.alpha;
  }
  object["body"] = to_json(operation.operand.front());
  return object;
}

ordered_json to_json(const MetaballBody& body) {
  ordered_json spheres = ordered_json::array();
  for (const Sphere& s : body.spheres) {
    spheres.push_back(ordered_json::array({s.center.x, s.center.y, s.center.z, s.radius}));
  }
  ordered_json object{{"type", "metaballs"},
                      {"kernel", kernel_word(body.kernel)},
                      {"a", body.a},
                      {"b", body.b},
                      {"blend_exponent", body.blend_exponent},
                      {"iso_value", body.iso_value},
                      {"cutoff_radii", body.cutoff_radii},
                      {"spheres", std::move(spheres)}};
  for (const SphereGroup& group : body.groups) object["groups"][group.name] = group.spheres;
  if (body.warp) object["warp"] = to_json(*body.warp);
  for (const BodyOperation& operation : body.operations) object["operations"].push_back(to_json(operation));
  return object;
}

// A layer's own fields, then those that every kind has.
void add_use(const LayerUse& use, ordered_json& layer) {
  if (use.locality) layer["locality"] = {{"group", use.locality->group}, {"width", use.locality->width}};
}

const char* type_of(Noise noise) {
  return noise == Noise::kSimplex ? "simplex" : noise == Noise::kPerlin ? "perlin" : "worley";
}

const char* distance_of(Noise noise) {
  return noise == Noise::kWorleyF1 ? "f1" : noise == Noise::kWorleyF2 ? "f2" : "f2-f1";
}

ordered_json to_json(const FractalLayer& layer) {
  ordered_json object{{"type", type_of(layer.noise)},   {"name", layer.name},
                      {"amplitude", layer.amplitude},   {"frequency", layer.frequency},
                      {"octaves", layer.octaves},       {"gain", layer.gain},
                      {"lacunarity", layer.lacunarity}, {"scale", to_json(layer.scale)},
                      {"bias", to_json(layer.bias)},    {"weight", layer.weight}};
  if (is_worley(layer.noise)) {
    object["distance"] = distance_of(layer.noise);
  } else {
    object["gradient_modulation"] = layer.gradient_modulation;
  }
  if (layer.warp) object["warp"] = to_json(*layer.warp);
  return object;
}

ordered_json to_json(const GaborLayer& layer) {
  ordered_json lobes = ordered_json::array();
  for (const GaborLobe& l : layer.lobes) {
    lobes.push_back(ordered_json::array({l.bandwidth, l.frequency_x, l.frequency_y, l.variance}));
  }
  ordered_json object{{"type", "gabor"},
                      {"name", layer.name},
                      {"pixel_size", layer.pixel_size},
                      {"height_rms", layer.height_rms},
                      {"impulses_per_kernel", layer.impulses_per_kernel},
                      {"exemplar_mean", layer.exemplar_mean},
                      {"exemplar_rms", layer.exemplar_rms}};
  if (layer.color) {
    object["color"] = {{"axis", to_json(layer.color->axis)}, {"mean", to_json(layer.color->mean)}};
  }
  object["lobes"] = std::move(lobes);
  return object;
}

ordered_json to_json(const SpotLayer& layer) {
  return {{"type", "spots"},
          {"name", layer.name},
          {"amplitude", layer.amplitude},
          {"inverted", layer.inverted},
          {"size", layer.size},
          {"cell_size", layer.cell_size},
          {"density", layer.density},
          {"probability", layer.probability},
          {"reach", layer.reach},
          {"least_weight", layer.least_weight},
          {"gaussian", layer.gaussian},
          {"alpha", layer.alpha},
          {"kappa", layer.kappa},
          {"beta", layer.beta},
          {"gamma", layer.gamma},
          {"variances", to_json(layer.variances)},
          {"sigma", layer.sigma},
          {"layers", layer.layers},
          {"lacunarity", layer.lacunarity},
          {"gain", layer.gain},
          {"exponent", layer.exponent}};
}

ordered_json to_json(const SparseLayer& layer) {
  return {{"type", "sparse"},
          {"name", layer.name},
          {"amplitude", layer.amplitude},
          {"cell_size", layer.cell_size},
          {"levels", layer.levels},
          {"probability", layer.probability},
          {"threshold", layer.threshold},
          {"gain", layer.gain},
          {"merged", layer.merged}};
}

ordered_json to_json(const RandomPhaseLayer& layer) {
  return {{"type", "random_phase"},
          {"name", layer.name},
          {"height_rms", layer.height_rms},
          {"cell_size", layer.cell_size},
          {"waves", layer.waves},
          {"frequency_min", layer.frequency_min},
          {"frequency_max", layer.frequency_max},
          {"exponent", layer.exponent},
          {"direction", to_json(layer.direction)},
          {"spread", layer.spread},
          {"randomness", layer.randomness}};
}

ordered_json to_json(const PhasorLayer& layer) {
  return {{"type", "phasor"},
          {"name", layer.name},
          {"amplitude", layer.amplitude},
          {"frequency", layer.frequency},
          {"cell_size", layer.cell_size},
          {"impulses_per_cell", layer.impulses_per_cell},
          {"direction", to_json(layer.direction)},
          {"spread", layer.spread},
          {"profile", profile_word(layer.profile)}};
}

template <typename T>
ordered_json to_json(const std::vector<std::pair<std::string, T>>& named) {
  ordered_json object = ordered_json::object();
  for (const auto& [name, value] : named) object[name] = value;
  return object;
}

ordered_json to_json(const Provenance& provenance) {
  return {{"tool", provenance.tool},
          {"input_name", provenance.input_name},
          {"input_sha256", provenance.input_sha256},
          {"options", to_json(provenance.options)},
          {"achieved", to_json(provenance.achieved)}};
}

ordered_json to_json(const Erosion& erosion) {
  return {{"talus_angle", erosion.talus_angle},
          {"iterations", erosion.iterations},
          {"density", erosion.density},
          {"rotation_period", erosion.rotation_period}};
}

ordered_json to_json(const Recipe& recipe) {
  ordered_json document{{"format_version", recipe.format_version}};
  if (!recipe.description.empty()) document["description"] = recipe.description;
  document["length_unit"] = recipe.length_unit;
  document["frame"] = recipe.frame;
  document["seed"] = recipe.seed;
  document["provenance"] = to_json(recipe.provenance);
  if (recipe.body) document["body"] = to_json(*recipe.body);
  document["layers"] = ordered_json::array();
  for (const Layer& layer : recipe.layers) {
    document["layers"].push_back(std::visit([](const auto& l) { return to_json(l); }, layer));
    if (const LayerUse* use = use_of(layer)) add_use(*use, document["layers"].back());
  }
  if (recipe.erosion) document["erosion"] = to_json(*recipe.erosion);
  return document;
}

// Shortest decimal that reads back to the same bits. A reader would take "-0" for the integer 0.
std::string number_text(double value) {
  if (value == 0.0 && std::signbit(value)) return "-0.0";
  char text[32];
  const auto end = std::to_chars(text, text + sizeof text, value);
  return {text, end.ptr};
}

std::string scalar_text(const ordered_json& value) {
  if (value.is_number_float()) return number_text(value.get<double>());
  return value.dump(-1, ' ', false, ordered_json::error_handler_t::replace);
}

bool is_row_of_numbers(const ordered_json& value) {
  return value.is_array() &&
         std::all_of(value.begin(), value.end(), [](const auto& v) { return v.is_number(); });
}

// Two spaces a level; an array of numbers stays on its line.
void print(const ordered_json& value, const std::string& indent, std::string& text) {
  if (!value.is_structured() || value.empty()) {
    text += scalar_text(value);
    return;
  }
  const bool row = is_row_of_numbers(value);
  const std::string inner = indent + "  ";
  text += value.is_array() ? '[' : '{';
  const char* separator = "";
  for (const auto& item : value.items()) {
    text += separator;
    separator = row ? ", " : ",";
    if (!row) text += '\n' + inner;
    if (value.is_object()) text += scalar_text(item.key()) + ": ";
    print(item.value(), inner, text);
  }
  if (!row) text += '\n' + indent;
  text += value.is_array() ? ']' : '}';
}

}  // namespace

std::string recipe_to_json(const Recipe& recipe) {
  try {
    validate_recipe(recipe, "recipe");
  } catch (const InputError& e) {
    throw WorkError(std::string("the recipe to be written is invalid: ") + e.what());
  }
  std::string text;
  print(to_json(recipe), "", text);
  return text + "\n";
}

void write_recipe(const Recipe& recipe, const std::filesystem::path& file) {
  const std::string text = recipe_to_json(recipe);
  OutputFile output(file);
  output.write(text.data(), text.size());
  output.commit();
}

double round_to_seven_digits(double x) {
  char text[32];
  const auto end = std::to_chars(text, text + sizeof text, x, std::chars_format::scientific, 6);
  double rounded = x;
  std::from_chars(text, end.ptr, rounded);
  return rounded;
}

}  // namespace astrolith
