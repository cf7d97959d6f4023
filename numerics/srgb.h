// The transfer function of sRGB (IEC 61966-2-1).
#pragma once

#include "numerics/portable_double.h"

namespace astrolith {

// The linear light of a gamma-encoded component; both in [0, 1].
inline double linear_of_srgb(double encoded) {
  return encoded <= 0.04045 ? encoded / 12.92 : portable::pow((encoded + 0.055) / 1.055, 2.4);
}

}  // namespace astrolith
