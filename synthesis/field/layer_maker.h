// How each kind of layer in a recipe becomes noise of the field's tables.
#pragma once

#include <functional>

#include "recipe/recipe.h"
#include "synthesis/body/layer_site.h"
#include "synthesis/field/field_tables.h"

namespace astrolith {

// Makes the noise of a layer at one site after another. Arrays that belong to the site are added to `arrays`.
using LayerMaker = std::function<LayerNoise(const LayerSite& site, ArrayStore& arrays)>;

// The maker of a layer. What all sites share is added to `arrays` at once. `layer` must outlive the maker.
// Expects a layer of noise that has a height or paints. Throws InputError, which begins with the source's
// place, for what the kind refuses.
LayerMaker layer_maker(const Layer& layer, const LayerSource& source, ArrayStore& arrays);

// How far beyond points a layer looks at the surface below it, length units; 0 for kinds that do not lie on
// other layers.
double reach_below(const Layer& layer);

}  // namespace astrolith
