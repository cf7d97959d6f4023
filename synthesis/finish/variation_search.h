// The search for variations of a recipe that are as alike as asked, by measure (thesis section 4.4).
#pragma once

#include <cstdint>
#include <functional>

#include "geometry/triangle_mesh.h"
#include "numerics/progress.h"
#include "recipe/recipe.h"

namespace astrolith {

// The shape that variations are compared with.
struct VariationReference {
  // Measures the similarity of a variation's mesh with the shape: 1 for equal shapes, less for others. Every
  // variation seed should draw samples of its own, since two samplings of one shape are not equal.
  std::function<double(const TriangleMesh& mesh, std::uint64_t variation_seed)> similarity;
  std::int64_t components = 1;  // closed pieces of the shape's surface
};

struct Variation {
  Recipe recipe;            // its provenance states the similarity
  double strength = 0.0;    // as vary_recipe() takes it (synthesis/finish/recipe_variation.h)
  double similarity = 0.0;  // with the reference
};

// The mesh by which a recipe's body is compared. The mesh is empty where the surface is.
TriangleMesh mesh_for_comparison(const Recipe& recipe);

// Finds the strongest variation whose mesh has a similarity of at least 1 - delta and as many components as
// the reference. The search halves the range of the strength five times, first with new noise, then, where
// new noise alone leaves less, with the recipe's own noise. Throws InputError when two samplings of one body
// differ by more than delta.
Variation find_variation(const Recipe& recipe, const VariationReference& reference, double delta,
                         std::uint64_t variation_seed, const Progress& progress = {});

}  // namespace astrolith
