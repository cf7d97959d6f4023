// The picture of a relief: its heights as grey values, the body seen from six sides.
//
// There is a panel for each axis and each sign of n_a, seen from outside along that axis, and further panels
// for what lies behind, as in a concavity. Pixels without a place are 0.
#pragma once

#include <cstdint>
#include <memory>
#include <string>
#include <vector>

#include "recipe/relief_layer.h"
#include "synthesis/relief/relief_places.h"

namespace astrolith {

struct ReliefLayout {
  int width = 0, height = 0;          // pixels; 0 where there is no place
  std::vector<std::uint32_t> pixels;  // (places) the number of each place's pixel, row-major
};

// The pixels of places in the order of find_relief_places().
ReliefLayout relief_layout(const std::vector<ReliefPlace>& places);

// The picture with a code of the layer at each place. Throws InputError, which begins with `where`, where it
// would have more than kMostHeightPictureSide pixels a side.
std::shared_ptr<ExemplarImage> relief_image(const ReliefLayer& layer, const std::vector<ReliefPlace>& places,
                                            const std::vector<std::uint16_t>& codes,
                                            const std::string& where);

}  // namespace astrolith
