#include <algorithm>
#include <charconv>
#include <cmath>
#include <nlohmann/json.hpp>

#include "numerics/errors.h"
#include "numerics/output_file.h"
#include "recipe/body_internal.h"
#include "recipe/landforms_internal.h"
#include "recipe/noise_layers_internal.h"
#include "recipe/recipe_json.h"

namespace astrolith {
namespace {

using nlohmann::ordered_json;

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
    ordered_json& written = document["layers"].back();
    std::visit(
        [&](const auto& l) {
          if (l.seed) written["seed"] = *l.seed;
        },
        layer);
    if (const LayerUse* use = use_of(layer)) add_use(*use, written);
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
