// Variations of a recipe that are as alike as asked, by measure (thesis section 4.4).
#pragma once

#include <cstdint>

#include "descriptor/shape_histogram.h"
#include "geometry/triangle_mesh.h"
#include "numerics/progress.h"
#include "recipe/recipe.h"

namespace astrolith {

// What variations are compared with: a shape, sampled as `compare` does by default (ahd).
struct VariationReference {
  ShapeHistogram histogram;
  std::int64_t components = 1;
};

// Of the recipe's own mesh.
VariationReference reference_of(const Recipe& recipe);
// Of a mesh.
VariationReference reference_of(const TriangleMesh& mesh, std::int64_t components);

struct Variation {
  Recipe recipe;            // provenance says its similarity
  double strength = 0.0;    // of synthesis/finish/recipe_variation.h
  double similarity = 0.0;  // with the reference, measured on a mesh
};

// The strongest variation (of five halvings of the strength's range) whose mesh has a similarity of at least
// 1 - delta and as many components as the reference: with new noise, or, where that alone leaves less, with
// the recipe's own. Throws InputError when two samplings of one body differ by more than delta.
Variation find_variation(const Recipe& recipe, const VariationReference& reference, double delta,
                         std::uint64_t variation_seed, const Progress& progress = {});

}  // namespace astrolith
