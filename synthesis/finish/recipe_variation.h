// Varies recipes: bodies of the same kind that are not the same body (thesis section 4.4),
// and finds variations that are as alike as asked, by measure.
#pragma once

#include <cstdint>
#include <functional>

#include "geometry/triangle_mesh.h"
#include "numerics/progress.h"
#include "recipe/recipe.h"

namespace astrolith {

enum class VariedNoise { kNew, kKept };

// Varies a recipe. It gets another seed, so that all noise is drawn anew, unless the noise is to be kept. In
// proportion to `strength` >= 0
//   - the whole body is bent by noise about as wide as itself and stretched along its axes; spheres move
//     together and grow with the space around them, so that what was joined stays joined;
//   - amplitudes and frequencies of fractal layers are multiplied by log-normal factors; masks and widths of
//     blends follow the heights that they are about.
// At strength 1 axes change by about a third and details by about a half. The same recipe, strength and
// variation seed give the same recipe; strengths of one seed lie on one path. The provenance stays that of
// the original, without its achieved results. The recipe must be valid and have a body.
Recipe vary_recipe(const Recipe& recipe, double strength, std::uint64_t variation_seed,
                   VariedNoise noise = VariedNoise::kNew);

// Measures the similarity of a variation's mesh with the shape that counts: 1 for equal shapes, less for
// others. Every variation seed should draw samples of its own, since two samplings of one shape are not
// equal.
using SimilarityMeasure = std::function<double(const TriangleMesh& mesh, std::uint64_t variation_seed)>;

struct Variation {
  Recipe recipe;                          // its provenance states the figures below
  double strength = 0.0;                  // as vary_recipe() takes it, 0 .. 1
  VariedNoise noise = VariedNoise::kNew;  // whether the noise is new too
  double similarity = 0.0;
  // Between the surfaces of the recipe's own body and of the variation, as fractions of the diagonal of the
  // box around the recipe's own body.
  double mean_distance = 0.0, max_distance = 0.0;
};

// The least mean distance of a variation from the recipe's own body. A body that is nearer is the same one.
inline constexpr double kLeastVariation = 1e-4;

// The mesh by which a recipe's body is compared. The mesh is empty where the surface is.
TriangleMesh mesh_for_comparison(const Recipe& recipe);

// The pieces and cavities of a closed mesh whose volume is at least a thousandth of the largest one's.
std::int64_t count_pieces(const TriangleMesh& mesh);

// Finds the strongest variation whose mesh has a similarity of at least 1 - delta, a mean distance from the
// recipe's own body of at least kLeastVariation, and as many pieces as that body has in a mesh of the same
// resolution. The search halves the strength from 1 on until a variation will do, and then halves the gap to
// the last that would not; first with new noise, then, where new noise alone is too different, with the
// recipe's own. Throws InputError where no variation will do; the message states the largest similarity that
// can be asked for. Throws WorkError when progress asks to stop before one was found.
Variation find_variation(const Recipe& recipe, const SimilarityMeasure& similarity, double delta,
                         std::uint64_t variation_seed, const Progress& progress = {});

}  // namespace astrolith
