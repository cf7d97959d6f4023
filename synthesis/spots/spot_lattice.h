// Makes the lattices that spots are drawn from (spot_draw.h).
#pragma once

#include <vector>

#include "recipe/recipe.h"
#include "synthesis/spots/spot_draw.h"

namespace astrolith {

// Cells of `cell_size` length units to an edge of 1, `density` impulses in an occupied one. Appends to the
// thresholds that the lattice points into.
SpotLattice make_spot_lattice(const SpotLayer& layer, double cell_size, double density, std::uint32_t seed,
                              std::vector<std::uint32_t>& thresholds);

}  // namespace astrolith
