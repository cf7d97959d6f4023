// Which of the cells around a box are looked at: where threads share a list, each looks at a part.
#pragma once

#include <cstdint>

#include "numerics/host_device.h"

namespace astrolith {

// The share of one who looks at all cells alone.
struct AllCells {
  ASTROLITH_HD std::uint64_t begin(std::uint64_t) const { return 0; }
  ASTROLITH_HD std::uint64_t end(std::uint64_t cells) const { return cells; }
};

}  // namespace astrolith
