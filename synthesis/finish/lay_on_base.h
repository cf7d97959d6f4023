// Lays the layers of one recipe on the body of another.
#pragma once

#include <string>

#include "recipe/recipe.h"

namespace astrolith {

// The base recipe with the layers of `details` after its own layers. Lengths of `details` are converted to
// the unit of the base: m and km convert into each other, px into nothing else, and "body" is the longest
// side of the bounding box of the base's body without layers, as a mesh of 64 cells shows it. Seed and frame
// are those of the base. A body in `details` is that from which the heights of reliefs are drawn. Throws
// InputError, which names the files by the two names, when the base has no body or an empty one, or the units
// do not convert.
Recipe lay_on_base(const Recipe& details, const std::string& details_name, const Recipe& base,
                   const std::string& base_name);

// The layer for another body than the one it was made for: a relief's heights are drawn from that one, where
// they are not already drawn from a third.
Layer drawn_from(const MetaballBody& measured, const Layer& layer);

// The layer for a body `ratio` times as large, or for a unit of length 1 / ratio times as long.
Layer rescaled(const Layer& layer, double ratio);

}  // namespace astrolith
