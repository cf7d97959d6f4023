// The name of the field that decides how high a layer is, for messages.
#pragma once

#include <string_view>

#include "recipe/recipe.h"

namespace astrolith {

// "amplitude", "height_rms" or "height_range"; "combine.width" where a blend's joint is wider than the layer
// is high; or the list of landforms, "craters", "boulders" or "population".
std::string_view height_field(const Layer& layer);

}  // namespace astrolith
