#include "tasks/estimation/texture_fit.h"

#include <fmt/format.h>

#include <algorithm>
#include <string_view>
#include <utility>

#include "estimation/gabor/exemplar/phase_exemplar.h"
#include "estimation/gabor/image/missing_ground.h"
#include "numerics/errors.h"
#include "numerics/progress.h"
#include "numerics/sample_statistics.h"
#include "recipe/recipe_json.h"
#include "tasks/estimation/photo_recipe.h"

namespace astrolith {
namespace {

void fit_lobes(const std::string& name, const TextureFitOptions& options, const Progress& progress,
               TextureFit& fit) {
  fit.lobes = fit_planes(fit.photo, name, options.photo, progress);
  fit.gaussianity = fit.lobes->gaussianity();
  fit.recipe = photo_recipe(*fit.lobes, options.recipe);
}

void make_random_phases(const std::string& name, const TextureFitOptions& options, const Progress& progress,
                        TextureFit& fit) {
  fit.image = phase_exemplar(fit.photo, name, options.recipe.seed, stretch(progress, 0.0, 0.5));
  fit.recipe = exemplar_recipe(*fit.image, options.recipe);
  fit.gaussianity =
      test_gaussianity(known_texture(fit.luma()), options.photo.seed, stretch(progress, 0.5, 1.0));
}

// An exemplar holds no missing ground.
void take_whole_part(std::vector<GreyImage>& photo, const std::string& name) {
  if (photo.front().missing.empty()) return;
  for (GreyImage& plane : photo) plane = largest_whole_part(plane);
  const GreyImage& part = photo.front();
  if (std::min(part.width, part.height) >= kLeastTextureSide) return;
  throw InputError(
      fmt::format("{}: its largest part without missing pixels is {} x {}, too small for an exemplar; fill "
                  "the gaps, or take "
                  "--model gabor",
                  name, part.width, part.height));
}

void take_exemplar(const std::string& name, const TextureFitOptions& options, const Progress& progress,
                   TextureFit& fit) {
  const std::uint64_t seed = options.recipe.seed;
  take_whole_part(fit.photo, name);
  fit.exemplar = fit.photo.size() == 1
                     ? prepare_exemplar(fit.photo.front(), name, seed, progress, options.border)
                     : prepare_exemplar(fit.photo, name, seed, progress, options.border);
  fit.image = fit.exemplar->layer;
  fit.recipe = exemplar_recipe(*fit.image, options.recipe);
  const TextureScore& score = fit.exemplar->score();
  fit.recipe.provenance.achieved = {{"direction_distance", score.direction},
                                    {"filter_distance", score.filters},
                                    {"value_distance", score.values}};
}

// A photo is no one texture where the grey values of its squares differ by this, in standard deviations.
constexpr double kUnlikeSquares = 0.5;

nlohmann::ordered_json to_json(const HeldOutScore& score) {
  return {{"values", score.mean.values}, {"filters", score.mean.filters}, {"scatter", score.scatter}};
}

nlohmann::ordered_json to_json(const ModelChoice& choice) {
  nlohmann::ordered_json figures = {
      {"squares", choice.squares}, {"side", choice.side}, {"models", nlohmann::ordered_json::object()}};
  if (choice.squares == 0) return figures;
  for (const TextureModel model : kTextureModels)
    figures["models"][std::string(model_word(model))] =
        to_json(choice.scores[static_cast<std::size_t>(model)]);
  figures["photo"] = to_json(choice.photo);
  return figures;
}

nlohmann::ordered_json to_json(const PreparedExemplar& exemplar) {
  auto scores = nlohmann::ordered_json::object();
  for (const ExemplarVariant variant : kExemplarVariants) {
    const auto& score = exemplar.scores[static_cast<int>(variant)];
    if (!score) continue;
    scores[std::string(variant_word(variant))] = {
        {"values", score->values}, {"filters", score->filters}, {"direction", score->direction}};
  }
  return {{"variant", std::string(variant_word(exemplar.variant))}, {"variants", std::move(scores)}};
}

}  // namespace

GreyImage TextureFit::luma() const { return photo.size() == 3 ? luma_image(photo) : photo.front(); }

std::optional<TextureModel> model_named(const std::string& name) {
  for (const TextureModel model : kTextureModels) {
    if (name == model_word(model)) return model;
  }
  return {};
}

TextureFit fit_texture(std::vector<GreyImage> photo, const std::string& name,
                       const TextureFitOptions& options, const StageProgress& progress) {
  TextureFit fit;
  fit.photo = std::move(photo);
  for (GreyImage& plane : fit.photo)
    plane = completed(std::move(plane), options.photo.seed, progress("gaps"));
  if (!options.model) {
    // What one of the models would refuse is refused before the comparison.
    require_exemplar(fit.luma(), name);
    if (fit.photo.size() == 3) require_colors(fit.photo, name);
    fit.choice = choose_model(largest_whole_part(fit.luma()), name, options.photo.fit, options.recipe.seed,
                              progress("models"));
  }
  fit.model = options.model ? *options.model : fit.choice->taken;
  switch (fit.model) {
    case TextureModel::kGabor:
      fit_lobes(name, options, progress("pursuit"), fit);
      break;
    case TextureModel::kPhase:
      make_random_phases(name, options, progress("phases"), fit);
      break;
    case TextureModel::kExemplar:
      take_exemplar(name, options, progress("exemplar"), fit);
      break;
  }
  return fit;
}

void write_texture_recipe(const TextureFit& fit, const Recipe& recipe, const std::filesystem::path& file) {
  fit.model == TextureModel::kGabor ? write_recipe(recipe, file) : write_exemplar_recipe(recipe, file);
}

nlohmann::ordered_json texture_figures(const TextureFit& fit) {
  nlohmann::ordered_json figures = {{"model", std::string(model_word(fit.model))}};
  if (fit.choice) figures["choice"] = to_json(*fit.choice);
  if (fit.exemplar) figures.update(to_json(*fit.exemplar));
  if (fit.lobes) figures.update(photo_figures(*fit.lobes));
  if (fit.model == TextureModel::kPhase) figures["variance_in_spectrum"] = variance_in_phases(fit);
  if (fit.gaussianity) figures.update(gaussianity_figures(*fit.gaussianity));
  return figures;
}

double variance_in_phases(const TextureFit& fit) {
  return fit.image->height_rms * fit.image->height_rms / sample_variance(fit.luma().values);
}

std::string choice_sentence(const TextureFit& fit) {
  if (!fit.choice) return "";
  const ModelChoice& c = *fit.choice;
  const std::string taken(model_word(fit.model));
  if (c.squares == 0) return taken + " is taken: too little of the photo has texture to compare models";
  std::string scores;
  for (const TextureModel model : kTextureModels) {
    const HeldOutScore& score = c.scores[static_cast<std::size_t>(model)];
    scores += fmt::format("{}{} {:.3f} +- {:.3f}", scores.empty() ? "" : ", ", model_word(model),
                          score.mean.sum(), score.scatter);
  }
  std::string sentence = fmt::format(
      "{} is taken, the simplest of the best on {} squares of {} pixels that it had not seen; differences in "
      "values and filters: {}; of the squares from each other {:.3f} +- {:.3f}",
      taken, c.squares, c.side, scores, c.photo.mean.sum(), c.photo.scatter);
  if (c.photo.mean.values > kUnlikeSquares)
    sentence += "; the photo changes from place to place: crop it to a part that looks alike";
  return sentence;
}

}  // namespace astrolith
