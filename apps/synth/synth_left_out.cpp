#include "apps/synth/synth_left_out.h"

#include <fmt/format.h>

#include <map>
#include <string>
#include <utility>

namespace astrolith {
namespace {

std::string name_of(const Layer& layer) {
  return std::visit([](const auto& l) { return l.name; }, layer);
}

// The layer in words, such as: layers[2] "grains" (gabor, 63 % of its variance).
std::string in_words(const LayerLeftOut& left, const Recipe& recipe) {
  std::string share = fmt::format("{:.3g} % of its variance", 100.0 * left.variance_share);
  if (left.landforms > 0.0) share = fmt::format("{:.3g} of its landforms, {}", left.landforms, share);
  if (left.layer < 0) return "body.warp (" + share + ")";
  const Layer& layer = recipe.layers[static_cast<std::size_t>(left.layer)];
  const std::string name = name_of(layer);
  return fmt::format("layers[{}]{} ({}, {})", left.layer, name.empty() ? "" : " \"" + name + "\"",
                     type_word(layer), share);
}

// Whether copies of an image lie on the body, of which a whole body gets some 64 along its side.
bool repeats_an_image(const LayerLeftOut& left, const Recipe& recipe) {
  if (left.layer < 0) return false;
  const Layer& layer = recipe.layers[static_cast<std::size_t>(left.layer)];
  return std::holds_alternative<ExemplarLayer>(layer) || std::holds_alternative<ReliefLayer>(layer);
}

std::string reason_of(const LayerLeftOut& left, const Recipe& recipe, const ImplicitField& field,
                      bool is_patch) {
  if (left.landforms > 0.0) {
    return is_patch ? "smaller than 8 spacings of float coordinates"
                    : "more than the 2e5 landforms that a whole body gets";
  }
  if (!is_patch && repeats_an_image(left, recipe))
    return "made of images of less than about 1/64 of the body";
  if (!is_patch) return "finer than float coordinates of a body of this size resolve";
  return field.has_local_form() ? "finer than the coordinates of this patch resolve"
                                : "finer than coordinates of a body made by operations resolve";
}

}  // namespace

void report_layers_left_out(Program& program, const ImplicitField& field, const Recipe& recipe,
                            const std::filesystem::path& file, bool is_patch) {
  auto list = nlohmann::ordered_json::array();
  std::map<std::string, std::string> words;  // by reason
  for (const LayerLeftOut& left : field.left_out()) {
    const std::string reason = reason_of(left, recipe, field, is_patch);
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
    if (left.landforms > 0.0) entry["landforms"] = left.landforms;
    list.push_back(std::move(entry));
    std::string& named = words[reason];
    named += (named.empty() ? "" : ", ") + in_words(left, recipe);
  }
  for (const auto& [reason, named] : words) {
    program.say(fmt::format("{}: left out, since {}: {}{}", file.string(), reason, named,
                            is_patch || !field.has_local_form() ? "" : "; a --patch shows it"));
  }
  program.summary["layers_left_out"] = std::move(list);
}

}  // namespace astrolith
