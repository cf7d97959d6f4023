// Counts and positions of the set bits of a 32-bit word, on the CPU and on a GPU.
#pragma once

#include <bit>
#include <cstdint>

#include "numerics/host_device.h"

namespace astrolith {

ASTROLITH_HD inline int count_bits(std::uint32_t bits) {
#ifdef __CUDA_ARCH__
  return __popc(bits);
#else
  // std::popcount is a call of a function in programs built for every x86-64.
  bits -= bits >> 1 & 0x55555555u;
  bits = (bits & 0x33333333u) + (bits >> 2 & 0x33333333u);
  bits = (bits + (bits >> 4)) & 0x0f0f0f0fu;
  return static_cast<int>(bits * 0x01010101u >> 24);
#endif
}

// The position of the lowest set bit, 0 .. 31. `bits` must not be 0.
ASTROLITH_HD inline int lowest_bit(std::uint32_t bits) {
#ifdef __CUDA_ARCH__
  return __ffs(static_cast<int>(bits)) - 1;
#else
  return std::countr_zero(bits);
#endif
}

}  // namespace astrolith
