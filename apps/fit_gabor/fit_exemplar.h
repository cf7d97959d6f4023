// fit_gabor --model exemplar: a photo becomes an exemplar layer and the PNG that the layer names.
#pragma once

#include <filesystem>
#include <string>

#include "apps/program.h"
#include "estimation/gabor/exemplar/exemplar_preparation.h"
#include "estimation/gabor/image/detrend.h"
#include "tasks/estimation/photo_recipe.h"

namespace astrolith {

// The photo's luma without its slow changes of brightness; `degree` 0: as it is. Says the reader's remarks.
GreyImage read_exemplar_photo(Program& program, const std::string& file, int degree, TrendModel trend);

// The recipe's layer with its physical scale.
ExemplarLayer scaled_exemplar(const PreparedExemplar& prepared, const PhotoRecipeOptions& options);

// The PNG beside a recipe: "rock.json" has "rock_exemplar.png".
std::filesystem::path exemplar_image_of(const std::filesystem::path& recipe);

// Writes the PNG and then the recipe that names it. The recipe has one exemplar layer at least.
void write_exemplar_recipe(Recipe recipe, const ExemplarLayer& layer, const std::filesystem::path& file);

// Puts variants and scores into the summary, and says them in words.
void report_exemplar(Program& program, const PreparedExemplar& prepared);

}  // namespace astrolith
