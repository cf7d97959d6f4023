// Draws the sizes and places of a population (recipe/landforms.h) on the bare body.
#pragma once

#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "numerics/hash_random.h"
#include "numerics/progress.h"
#include "recipe/recipe.h"
#include "synthesis/landforms/bare_surface.h"

namespace astrolith {

struct DrawnLandform {
  Vec3d position;           // on the bare surface
  double diameter = 0.0;    // length units
  CounterRandom random{0};  // the landform's own random numbers, for its other properties
};

// The weight of a place on the bare surface, in [0, 1]. It may be called from many threads. Empty: 1
// everywhere.
using PlaceWeight = std::function<float(const Vec3d&)>;

// Where a population is drawn, and with what weight.
struct DrawingPlaces {
  PlaceWeight weight;
  // For a population that is drawn by cells: the box that the landforms matter to. Absent: the whole body.
  std::optional<Box> region = std::nullopt;
  double reach = 0.5;      // how far from its place a landform matters, in its diameters
  double margin = 0.0;     // how far layers may move points of the surface, length units
  Progress progress = {};  // asked some times a second
};

// The diameter at quantile u of the population's law, the power law or Weibull's. A u from 0 to 1 gives one
// within the limits. One below 0 gives the diameter that the law continued below the least has there.
double diameter_at(const Population& population, double u);
// The inverse of diameter_at(): the share of the landforms that are smaller than a diameter, below 0 for one
// below the least.
double share_below(const Population& population, double diameter);

// The landforms of a population. With a constant weight, landform i of a population that is not drawn by
// cells does not depend on the count. Throws InputError, naming `where`, when a density would draw more than
// about kMaxDrawnLandforms, or when the weight is so small everywhere that a count finds no places; WorkError
// where the progress asks to stop.
std::vector<DrawnLandform> draw_population(const Population& population, const BareSurface& surface,
                                           std::uint64_t seed, int layer_index, const std::string& where,
                                           const DrawingPlaces& places = {});

}  // namespace astrolith
