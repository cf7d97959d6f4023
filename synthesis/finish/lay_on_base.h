// Lays the layers of one recipe on the body of another.
#pragma once

#include <string>

#include "recipe/recipe.h"

namespace astrolith {

// The base recipe with the layers of `details` after its own, their lengths converted to the base's unit (m
// and km convert; px converts to nothing but px). Seed and frame are the base's; a body in `details` is
// ignored. Throws InputError, naming the files by the two names, when the base has no body or the units do
// not convert.
Recipe lay_on_base(const Recipe& details, const std::string& details_name, const Recipe& base,
                   const std::string& base_name);

// The same layer on a body `ratio` times as large, or in a unit 1 / ratio times as long.
Layer rescaled(const Layer& layer, double ratio);

}  // namespace astrolith
