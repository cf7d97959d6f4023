// Variations measured against a mesh: the measure of similarity, and the words for the result.
#pragma once

#include <nlohmann/json.hpp>
#include <string>

#include "geometry/triangle_mesh.h"
#include "synthesis/finish/recipe_variation.h"

namespace astrolith {

// Measures the similarity with a mesh as `compare` does by default: histograms of the features called ahd, of
// 10,000 points of evened surfaces. Throws InputError for a mesh without area, and for one that passes
// through itself so often that it is no surface.
SimilarityMeasure similarity_with(const TriangleMesh& mesh);

// "strength 0.31, new noise; 0.84 % of the diagonal from the recipe's own body on average, 2.5 % at most"
std::string describe(const Variation& variation);

// The figures of a variation: similarity, strength, noise ("new" or "kept"), and its mean and largest
// distance from the recipe's own body as fractions of the diagonal.
nlohmann::ordered_json to_json(const Variation& variation);

}  // namespace astrolith
