// Draws a population cell by cell of space, so that a small region of the body draws only its own landforms.
//
// Sizes fall into classes, each half as wide as the one before. Each class has a lattice of cubic cells,
// which hold Poisson points of uniform density. A point within h of the bare surface is projected onto it.
// Since as many points come from outside as from inside, the density on the surface is uniform up to (h /
// radius of curvature)^2 / 3. The numbers of a cell depend on the seed, the layer, the class and the cell
// alone.
#pragma once

#include <string>
#include <vector>

#include "synthesis/landforms/population.h"

namespace astrolith {

// The most landforms that are drawn by cells for a whole body, on average; finer ones are left out.
inline constexpr double kMostByCellsOnBody = 2e5;
// The greatest diameter of a population that is drawn by cells, in longest sides of the bare body.
inline constexpr double kGreatestByCells = 1.0 / 32.0;
// The least diameter that is drawn by cells, in largest coordinates of the bare body: 8 spacings of float.
// The ground that a landform lies on is found to about one.
inline constexpr double kLeastByCells = 0x1p-20;

// The sizes that are drawn of such a population.
struct SizesByCells {
  int classes = 0;               // number of classes that are drawn, from the greatest diameter down
  double least = 0.0;            // the least diameter that is drawn, length units
  double number_left_out = 0.0;  // how many smaller landforms the whole body would have, on average
  double share_left_out = 0.0;   // their share in the variance of the heights of the whole population, [0, 1]
};
SizesByCells sizes_by_cells(const Population& population, const BareSurface& surface, bool whole_body);

// draw_population() of a population with `by_cells`. Expects one that validation accepts. Throws as that
// does, and InputError where greatest_diameter is above kGreatestByCells.
std::vector<DrawnLandform> draw_population_by_cells(const Population& population, const BareSurface& surface,
                                                    std::uint64_t seed, int layer_index,
                                                    const std::string& where, const DrawingPlaces& places);

}  // namespace astrolith
