// A photo becomes the layers of a recipe by one of three models of its texture.
#pragma once

#include <filesystem>
#include <nlohmann/json.hpp>
#include <optional>
#include <string>
#include <vector>

#include "estimation/gabor/exemplar/exemplar_preparation.h"
#include "estimation/gabor/model_choice.h"
#include "estimation/gabor/photo_fit.h"
#include "numerics/progress.h"
#include "recipe/recipe.h"
#include "tasks/estimation/photo_recipe.h"

namespace astrolith {

struct TextureFitOptions {
  std::optional<TextureModel> model;      // none: that of choose_model()
  std::optional<ExemplarVariant> border;  // of an exemplar; none: the nearest
  PhotoFitOptions photo;
  PhotoRecipeOptions recipe;
};

struct TextureFit {
  TextureModel model = TextureModel::kGabor;
  std::optional<ModelChoice> choice;         // where it was chosen
  std::vector<GreyImage> photo;              // grey, or red, green and blue
  std::optional<PhotoFit> lobes;             // of kGabor
  std::optional<PreparedExemplar> exemplar;  // of kExemplar
  std::optional<ExemplarLayer> image;      // of kPhase and kExemplar; lengths are pixels, heights grey values
  std::optional<Gaussianity> gaussianity;  // of the photo; none for kExemplar and where the fit was stopped
  Recipe recipe;  // tool, input and options of its provenance are the caller's; an image is not yet written

  GreyImage luma() const;
};

// The model of that name: "gabor", "phase", "exemplar"; none for "auto".
std::optional<TextureModel> model_named(const std::string& name);

// Fits a photo, which messages call `name`: one plane of grey, or red, green and blue, without its trend
// (flatten()). A fit of lobes that is asked to stop is the best so far. Throws as choose_model(),
// fit_planes(), phase_exemplar() and prepare_exemplar() do.
TextureFit fit_texture(std::vector<GreyImage> photo, const std::string& name,
                       const TextureFitOptions& options, const StageProgress& progress);

// Writes the recipe, and before it the image of a layer that has one.
void write_texture_recipe(const TextureFit& fit, const Recipe& recipe, const std::filesystem::path& file);

// The model, the scores of all models where it was chosen, and the figures of its fit, for summaries.
nlohmann::ordered_json texture_figures(const TextureFit& fit);

// The share of the photo's variance that an image of random phases has.
double variance_in_phases(const TextureFit& fit);

// What was chosen and why, in one sentence; empty where there was no choice.
std::string choice_sentence(const TextureFit& fit);

}  // namespace astrolith
