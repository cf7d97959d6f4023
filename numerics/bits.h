// Bits of a word, on both machines.
#pragma once

#include <bit>
#include <cstdint>

#include "numerics/host_device.h"

namespace astrolith {

ASTROLITH_HD inline int count_bits(std::uint32_t bits) {
#ifdef __CUDA_ARCH__
  return __popc(bits);
#else
  return std::popcount(bits);
#endif
}

// Number of the lowest bit that is set; there must be one.
ASTROLITH_HD inline int lowest_bit(std::uint32_t bits) {
#ifdef __CUDA_ARCH__
  return __ffs(static_cast<int>(bits)) - 1;
#else
  return std::countr_zero(bits);
#endif
}

}  // namespace astrolith
