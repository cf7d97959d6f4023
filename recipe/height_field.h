// The name of the field that decides how high a layer is, for messages.
#pragma once

#include <string_view>

#include "recipe/recipe.h"

namespace astrolith {

// "amplitude" or "height_rms"; "combine.width" where a blend's joint is wider than the layer is high; or the
// list of landforms, "craters", "boulders" or "population".
std::string_view height_field(const Layer& layer);

}  // namespace astrolith
