#include "apps/synth/synth_left_out.h"

#include <fmt/format.h>

#include <string>
#include <utility>

namespace astrolith {
namespace {

std::string name_of(const Layer& layer) {
  return std::visit([](const auto& l) { return l.name; }, layer);
}

// The layer in words, such as: layers[2] "grains" (gabor, 63 % of its variance).
std::string in_words(const LayerLeftOut& left, const Recipe& recipe) {
  const std::string share = fmt::format("{:.3g} % of its variance", 100.0 * left.variance_share);
  if (left.layer < 0) return "body.warp (" + share + ")";
  const Layer& layer = recipe.layers[static_cast<std::size_t>(left.layer)];
  const std::string name = name_of(layer);
  return fmt::format("layers[{}]{} ({}, {})", left.layer, name.empty() ? "" : " \"" + name + "\"",
                     type_word(layer), share);
}

std::string reason_in(const ImplicitField& field, bool is_patch) {
  if (!is_patch) return "finer than float coordinates of a body of this size resolve";
  return field.has_local_form() ? "finer than the coordinates of this patch resolve"
                                : "finer than coordinates of a body made by operations resolve";
}

}  // namespace

void report_layers_left_out(Program& program, const ImplicitField& field, const Recipe& recipe,
                            const std::filesystem::path& file, bool is_patch) {
  const std::string reason = reason_in(field, is_patch);
  auto list = nlohmann::ordered_json::array();
  std::string words;
  for (const LayerLeftOut& left : field.left_out()) {
    nlohmann::ordered_json entry;
    if (left.layer < 0) {
      entry = {{"layer", nullptr}, {"name", ""}, {"type", "body warp"}};
    } else {
      const Layer& layer = recipe.layers[static_cast<std::size_t>(left.layer)];
      entry = {{"layer", left.layer}, {"name", name_of(layer)}, {"type", std::string(type_word(layer))}};
    }
    entry["reason"] = reason;
    entry["finest_length"] = left.finest;
    entry["variance_share"] = left.variance_share;
    list.push_back(std::move(entry));
    words += (words.empty() ? "" : ", ") + in_words(left, recipe);
  }
  if (!words.empty()) {
    program.say(fmt::format("{}: left out, since {}: {}{}", file.string(), reason, words,
                            is_patch || !field.has_local_form() ? "" : "; a --patch shows it"));
  }
  program.summary["layers_left_out"] = std::move(list);
}

}  // namespace astrolith
