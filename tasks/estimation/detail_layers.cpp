#include "tasks/estimation/detail_layers.h"

#include <fmt/format.h>

#include <algorithm>
#include <span>
#include <vector>

#include "estimation/shape/details/details_fit.h"
#include "estimation/shape/details/residual_texture.h"
#include "numerics/errors.h"
#include "numerics/length_unit.h"
#include "recipe/recipe_json.h"
#include "synthesis/field/implicit_field.h"
#include "synthesis/finish/lay_on_base.h"
#include "tasks/job/load_recipe.h"

namespace astrolith {
namespace {

// Diagonal of the bare body's box, in the recipe's unit.
double body_diagonal(const Recipe& recipe) {
  Recipe bare;
  bare.body = recipe.body;
  const Box box = ImplicitField(bare).bounds();
  if (box.empty()) throw InputError("body.iso_value: no point of the body reaches it; lower it");
  return box.diagonal();
}

std::string layer_path(std::string_view option, const std::string& file, std::size_t layer) {
  return fmt::format("{}: {}: layers[{}]", option, file, layer);
}

// A fit knows no groups of metaballs, so that no layer of its recipe can be bound to one.
void check_no_group(const Layer& layer, const std::string& place) {
  if (find_locality(layer) == nullptr) return;
  throw InputError(place + (find_use(layer) == nullptr ? ".population" : "") +
                   ".locality.group: a fitted body has no groups; take `locality` out of the layer, or lay "
                   "it on the recipe with synth --base once that has the group");
}

// Only Gabor layers are taken from a photo's recipe. Expects a recipe that was read without errors.
void check_masking_layer(const Recipe& rock, std::size_t index, const std::string& place) {
  const LayerUse* use = find_use(rock.layers[index]);
  if (use == nullptr || !use->mask) return;
  const int masking = find_layer(std::span(rock.layers).first(index), use->mask->layer);
  if (masking >= 0 && std::holds_alternative<GaborLayer>(rock.layers[static_cast<std::size_t>(masking)]))
    return;
  throw InputError(place +
                   ".mask.layer: names a layer that is no Gabor layer, and only Gabor layers are taken; take "
                   "`mask` out of the layer");
}

void check_not_after_warp(const std::vector<Layer>& before, const std::string& place) {
  const auto warps = [](const Layer& layer) {
    const LayerUse* use = find_use(layer);
    return use != nullptr && use->combination.kind == Combine::kWarp;
  };
  if (std::none_of(before.begin(), before.end(), warps)) return;
  throw InputError(place +
                   ": a Gabor layer cannot stand after a layer that warps, which --details has; take that "
                   "layer out of the recipe of --details");
}

// The layer with pixels of this size, and with its heights multiplied by a ratio.
GaborLayer scaled(const GaborLayer& layer, double pixel_size, double height) {
  GaborLayer result = layer;
  result.pixel_size = pixel_size;
  result.height_rms *= height;
  result.use.combination.width *= height;
  if (result.use.mask) result.use.mask->rescale_heights(height);
  return result;
}

}  // namespace

Recipe read_details(const std::string& file) {
  Recipe other = load_recipe(file);
  if (!other.body) {
    throw InputError(file +
                     ": body: absent, so nobody knows how large its layers are; lay them on a body with "
                     "synth --base");
  }
  if (other.layers.empty()) throw InputError(file + ": layers: none; give a recipe with details");
  for (std::size_t i = 0; i < other.layers.size(); ++i)
    check_no_group(other.layers[i], layer_path("--details", file, i));
  return other;
}

double transfer_details(const Recipe& other, Recipe& recipe) {
  const double ratio = body_diagonal(recipe) / body_diagonal(other);
  for (const Layer& layer : other.layers) recipe.layers.push_back(rescaled(layer, ratio));
  return ratio;
}

void add_micro_layers(const std::string& file, double mm_per_px, double height_mm, Recipe& recipe) {
  Recipe rock = load_recipe(file);
  const double mm = 1e-3 / metres_per_unit(recipe.length_unit);
  const GaborLayer* first = nullptr;
  for (const Layer& layer : rock.layers) {
    const auto* gabor = std::get_if<GaborLayer>(&layer);
    if (gabor == nullptr || !(gabor->height_rms > 0.0)) continue;
    if (first == nullptr) first = gabor;
  }
  if (first == nullptr) {
    throw InputError(file + ": layers: none is a Gabor layer with a height; give a recipe of fit_gabor");
  }
  if (rock.length_unit == "px" && !(mm_per_px > 0.0 && height_mm > 0.0)) {
    throw InputError(file + ": lengths are pixels; give --mm-per-px and --micro-height");
  }
  const double unit = metres_per_unit(rock.length_unit) / metres_per_unit(recipe.length_unit);
  const double height = height_mm > 0.0 ? mm * height_mm / first->height_rms : unit;
  std::vector<Layer> added;
  for (std::size_t i = 0; i < rock.layers.size(); ++i) {
    const auto* gabor = std::get_if<GaborLayer>(&rock.layers[i]);
    if (gabor == nullptr) continue;
    const std::string place = layer_path("--micro", file, i);
    check_no_group(*gabor, place);
    check_masking_layer(rock, i, place);
    check_not_after_warp(recipe.layers, place);
    added.push_back(scaled(*gabor, mm_per_px > 0.0 ? mm * mm_per_px : unit * gabor->pixel_size, height));
  }
  recipe.layers.insert(recipe.layers.end(), added.begin(), added.end());
}

std::string add_residual_texture(const TargetBody& target, std::uint64_t seed, const Progress& progress,
                                 Recipe& recipe) {
  ResidualTextureOptions options;
  options.seed = seed;
  const ResidualTexture texture =
      fit_residual_texture(target, in_target_frame(target, *recipe.body), options, progress);
  GaborLayer layer = texture.layer;
  layer.pixel_size = round_to_seven_digits(target.diagonal * layer.pixel_size);
  layer.height_rms = round_to_seven_digits(target.diagonal * layer.height_rms);
  recipe.layers.push_back(layer);
  return fmt::format("{} lobes from {} patches, height {:.3g} {} rms", layer.lobes.size(), texture.patches,
                     layer.height_rms, recipe.length_unit);
}

}  // namespace astrolith
