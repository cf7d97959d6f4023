// The noise that a layer becomes: how it is made, and what is asked of it whatever its kind. Noise without
// heights has none of these facts.
#pragma once

#include <cstdint>
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

// A bound of the |height|, length units.
double noise_height_bound(const LayerNoise& noise);

// How fine the noise is, and what its frame could not hold of it.
NoiseDetail noise_detail(const LayerNoise& noise);

// Whether the noise of the body's frame keeps all digits of coordinates local to a patch.
bool has_local_form(const LayerNoise& noise);

// The number of lists of impulses that a block has for the noise.
std::uint32_t num_impulse_lists(const LayerNoise& noise);

// The number of random draws that the impulses around a point take; 0 for noise without impulses.
double draws_at_a_point(const LayerNoise& noise, const ArrayView& arrays);

}  // namespace astrolith
