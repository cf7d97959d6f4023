// What is asked of a layer's noise whatever its kind. Noise without heights has none of these facts.
#pragma once

#include <cstdint>

#include "synthesis/field/field_tables.h"

namespace astrolith {

// A bound of the |height|, length units.
double height_bound_of(const LayerNoise& noise);

// How fine the noise is, and what its frame could not hold of it.
NoiseDetail detail_of(const LayerNoise& noise);

// Whether the noise of the body's frame keeps all digits of coordinates local to a patch.
bool has_local_form(const LayerNoise& noise);

// The number of lists of impulses that a block has for the noise.
std::uint32_t num_impulse_lists(const LayerNoise& noise);

// The number of random draws that the impulses around a point take; 0 for noise without impulses.
double draws_at_a_point(const LayerNoise& noise, const ArrayView& arrays);

}  // namespace astrolith
