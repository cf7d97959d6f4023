#include "tasks/estimation/detail_layers.h"

#include <fmt/format.h>

#include "estimation/shape/details/detailed_check.h"
#include "estimation/shape/details/residual_texture.h"
#include "numerics/errors.h"
#include "recipe/recipe_json.h"
#include "synthesis/field/implicit_field.h"
#include "synthesis/finish/lay_on_base.h"
#include "tasks/synthesis/load_recipe.h"

namespace astrolith {
namespace {

// Diagonal of the bare body's box, in the recipe's unit.
double size_of(const Recipe& recipe) {
  Recipe bare;
  bare.body = recipe.body;
  const Box box = ImplicitField(bare).bounds();
  if (box.empty()) throw InputError("body.iso_value: no point of the body reaches it; lower it");
  return box.diagonal();
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
  return other;
}

double transfer_details(const Recipe& other, Recipe& recipe) {
  const double ratio = size_of(recipe) / size_of(other);
  for (const Layer& layer : other.layers) recipe.layers.push_back(rescaled(layer, ratio));
  return ratio;
}

void add_micro_layers(const std::string& file, double mm_per_px, double height_mm, Recipe& recipe) {
  Recipe rock = load_recipe(file);
  const double mm = recipe.length_unit == "km" ? 1e-6 : 1e-3;
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
  const double unit = rock.length_unit == recipe.length_unit ? 1.0 : rock.length_unit == "km" ? 1e3 : 1e-3;
  const double height = height_mm > 0.0 ? mm * height_mm / first->height_rms : unit;
  for (const Layer& layer : rock.layers) {
    if (const auto* gabor = std::get_if<GaborLayer>(&layer)) {
      GaborLayer micro = *gabor;
      micro.pixel_size = mm_per_px > 0.0 ? mm * mm_per_px : unit * gabor->pixel_size;
      micro.height_rms *= height;
      recipe.layers.push_back(micro);
    }
  }
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
