// The shapes that synth and fit_shape compare variations with. The similarity is the one that `compare`
// measures by default: histograms of the features called ahd.
#pragma once

#include <cstdint>

#include "geometry/triangle_mesh.h"
#include "recipe/recipe.h"
#include "synthesis/finish/variation_search.h"

namespace astrolith {

// The recipe's own body. Throws InputError where its surface is empty.
VariationReference reference_of(const Recipe& recipe);
// A mesh with the given number of closed pieces.
VariationReference reference_of(const TriangleMesh& mesh, std::int64_t components);

}  // namespace astrolith
