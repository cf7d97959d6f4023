// Sizes of tests that can be small or large. scripts/test.sh --full asks for large ones, which take minutes
// instead of seconds.
#pragma once

#include <cstdlib>

namespace astrolith::testing {

inline bool full_size() { return std::getenv("ASTROLITH_FULL_TESTS") != nullptr; }

template <typename T>
T by_size(T quick, T full) {
  return full_size() ? full : quick;
}

}  // namespace astrolith::testing
