// Makes the lattices that spots are drawn from (spot_draw.h).
#pragma once

#include <vector>

#include "recipe/recipe.h"
#include "synthesis/spots/spot_draw.h"

namespace astrolith {

// The lattice of a layer, scaled so that an edge of length 1 becomes `cell_size` length units long. An
// occupied cell holds `density` impulses on average. Appends the thresholds of the lattice to `thresholds`.
SpotLattice make_spot_lattice(const SpotLayer& layer, double cell_size, double density, std::uint32_t seed,
                              std::vector<std::uint32_t>& thresholds);

}  // namespace astrolith
