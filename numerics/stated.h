// A member of a plain struct that has no default.
#pragma once

#include "numerics/host_device.h"

namespace astrolith {

// A struct with such members compiles only where every one of them is given a value.
template <class T>
struct Stated {
  T value;

  ASTROLITH_HD constexpr Stated(T stated) : value(stated) {}
  ASTROLITH_HD constexpr operator T() const { return value; }
};

}  // namespace astrolith
