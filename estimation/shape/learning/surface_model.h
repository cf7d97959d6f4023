// The numbers of a learnt surface, and the layers of a recipe that they stand for.
//
// The surface is a fractal noise, whose amplitude varies over the body under the mask of a second noise, and
// at most one population of landforms. Lengths are in edges of the target's evened surface
// (descriptor/surface/evened_surface.h), so that one set of ranges serves every body.
#pragma once

#include <string>
#include <vector>

#include "recipe/recipe.h"

namespace astrolith {

enum class LandformKind { none, boulders, craters };
// "none", "boulders" or "craters".
const char* name_of(LandformKind kind);

struct SurfaceModel {
  double amplitude = 0.0;         // of the noise's first octave, edges
  double wavelength = 24.0;       // of that octave, edges
  double gain = 0.5;              // (0, 1)
  double contrast = 0.1;          // of rough and smooth regions: the mask's transition is 2 / contrast wide
  double mask_wavelength = 40.0;  // edges
  LandformKind landforms = LandformKind::none;
  double count = 0.0;      // of landforms
  double exponent = 2.5;   // of their power law
  double least = 2.5;      // diameter, edges
  double greatest = 20.0;  // diameter, edges
  double shape = 0.4;      // boulders: mean burial; craters: depth over diameter
};

// The layers for an edge in the recipe's length unit. A model without amplitude has no noise. `group` names a
// group of the body's metaballs that the layers are tied to, or is empty; `width` is the locality's, in the
// length unit. Numbers are rounded as a recipe stores them.
std::vector<Layer> layers_of(const SurfaceModel& model, double edge, const std::string& group = "",
                             double width = 0.0);

// How many numbers of a model are searched: 5, and 4 more with landforms.
std::size_t searched_numbers(LandformKind kind);

// The model at a point of the search, relative to the centre: x lies in [-1, 1]^n, and 0 is the centre.
SurfaceModel model_at(const SurfaceModel& centre, const std::vector<double>& x);

}  // namespace astrolith
