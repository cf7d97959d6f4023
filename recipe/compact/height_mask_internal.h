// Which pixels of a picture have a height.
#pragma once

#include "recipe/compact/bit_mixture.h"
#include "recipe/compact/height_picture.h"

namespace astrolith {

// Writes which values are not 0; or reads it, and makes the values 0 and 1. Each pixel is predicted from the
// pixels around it that came before, as in JBIG: from the nearest ten, and from the nearest sixteen.
void code_mask(HeightPicture& picture, BitCoder& coder);

}  // namespace astrolith
