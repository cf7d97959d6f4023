// The recipe of a photo's exemplar layer, the PNG that the layer names, and the figures of its preparation.
#pragma once

#include <filesystem>
#include <nlohmann/json.hpp>
#include <vector>

#include "estimation/gabor/exemplar/exemplar_preparation.h"
#include "estimation/gabor/image/detrend.h"
#include "estimation/gabor/image/image_reader.h"
#include "estimation/gabor/photo_fit.h"
#include "tasks/estimation/photo_recipe.h"

namespace astrolith {

// The photo without its slow changes of brightness, with the reader's remarks; `degree` 0: as it is. There
// are three planes where `colors` is set, else one, the luma.
ColorImageFile read_exemplar_photo(const std::string& file, bool colors, int degree, TrendModel trend);
// Prepares a photo of one plane, or of red, green and blue. Throws as prepare_exemplar() does.
PreparedExemplar prepare_photo(const std::vector<GreyImage>& planes, const std::string& name,
                               std::uint64_t seed, const Progress& progress);
// Takes a polynomial of the degree out of a photo that is large enough for an exemplar.
void flatten_exemplar_photo(GreyImage& photo, int degree, TrendModel trend, const std::string& name);

// The recipe with the exemplar layer in its physical scale, not yet with its image. Its provenance states
// what was achieved; tool, input and options of the provenance are the caller's.
Recipe exemplar_recipe(const PreparedExemplar& prepared, const PhotoRecipeOptions& options);

// The PNG beside a recipe: "rock.json" has "rock_exemplar.png".
std::filesystem::path exemplar_image_of(const std::filesystem::path& recipe);

// Writes the PNG of the recipe's only layer, an exemplar, and then the recipe that names it.
void write_exemplar_recipe(Recipe recipe, const std::filesystem::path& file);

// The variant, and the scores of all variants, for summaries.
nlohmann::ordered_json exemplar_figures(const PreparedExemplar& prepared);

// The score of a texture of the lobes. `synthesis` is the first channel's, of unit variance.
TextureScore score_of_lobes(const PhotoFit& photo, const std::vector<float>& synthesis);

}  // namespace astrolith
