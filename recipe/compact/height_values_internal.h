// The heights of the pixels that have one.
#pragma once

#include "recipe/compact/bit_mixture.h"
#include "recipe/compact/height_picture.h"

namespace astrolith {

struct HeightRange {
  int low = 0, high = 0;  // 1 <= low <= high <= 65535
};

// How heights are predicted: closely, or from fewer pixels, which is quicker and takes more bytes.
enum class Prediction { kClose, kQuick };

// Writes the values that are not 0, or reads them in their place. All are in `range`.
void code_heights(HeightPicture& picture, const HeightRange& range, Prediction prediction, BitCoder& coder);

}  // namespace astrolith
