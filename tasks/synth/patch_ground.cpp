#include "tasks/synth/patch_ground.h"

#include <algorithm>

#include "tasks/synth/body_mesh.h"

namespace astrolith {
namespace {

bool is_relief(const Layer& layer) { return std::holds_alternative<ReliefLayer>(layer); }

bool adds_details(const Layer& layer) {
  const Population* drawn = population_of(layer);
  return (drawn != nullptr && drawn->by_cells) || traits_of(layer).in_plane;
}

const std::string& layer_name(const Layer& layer) {
  return std::visit([](const auto& l) -> const std::string& { return l.name; }, layer);
}

bool is_asked_by_a_mask(const Recipe& recipe, const std::string& name) {
  return std::any_of(recipe.layers.begin(), recipe.layers.end(), [&](const Layer& layer) {
    const LayerMask* mask = mask_of(layer);
    return mask != nullptr && mask->layer == name;
  });
}

}  // namespace

std::optional<Recipe> without_additions(const Recipe& recipe) {
  const bool measured = std::any_of(recipe.layers.begin(), recipe.layers.end(), is_relief);
  Recipe ground = recipe;
  bool added = false;
  for (Layer& layer : ground.layers) {
    if (ReliefLayer* relief = std::get_if<ReliefLayer>(&layer)) {
      added |= relief->finer > 0 || relief->fill_unseen;
      relief->finer = 0;
      relief->fill_unseen = false;
    } else if ((measured || adds_details(layer)) && !is_asked_by_a_mask(recipe, layer_name(layer))) {
      layer = BoulderLayer{};  // without a boulder
      added = true;
    }
  }
  if (!added) return std::nullopt;
  return ground;
}

std::optional<ImplicitField> field_of_ground(const Recipe& recipe, const std::filesystem::path& file,
                                             const Region& region) {
  if (!region.is_patch) return std::nullopt;
  const std::optional<Recipe> ground = without_additions(recipe);
  if (!ground) return std::nullopt;
  return field_of_region(*ground, file, region);
}

void place_patch(const Recipe& recipe, const std::filesystem::path& file, const ImplicitField& field,
                 Region& region) {
  if (const std::optional<ImplicitField> ground = field_of_ground(recipe, file, region)) {
    place_on_ground(*ground, region);
  }
  if (!region.plane) place_on_ground(field, region);
}

}  // namespace astrolith
