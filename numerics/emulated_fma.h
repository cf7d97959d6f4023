// a*b + c with one rounding, for machines without such an instruction (WebAssembly).
#pragma once

#include <bit>
#include <cstdint>

namespace astrolith {

// The product of two floats is exact in a double. Here the sum is rounded to odd: where it is not exact, its
// last bit becomes 1. A double has more than twice as many bits as a float and two more, so that the second
// rounding is right (Boldo and Melquiond, "Emulation of FMA and correctly rounded sums", 2008).
[[gnu::noinline]] inline float fma_by_odd_sum(double product, double addend) {
  const double sum = product + addend;
  const double added = sum - product;
  const double error = (product - (sum - added)) + (addend - added);  // exact (Knuth's two-sum)
  const std::int64_t bits = std::bit_cast<std::int64_t>(sum);
  // The neighbour of the sum in the error's direction is nearer to 0 where the signs differ. The error of an
  // infinite sum is no number, and counts as none.
  const std::int64_t away = (error > 0.0) == (sum > 0.0) ? 1 : -1;
  const std::int64_t inexact = (error > 0.0) != (error < 0.0) ? 1 : 0;
  return static_cast<float>(std::bit_cast<double>(bits + (away & -(inexact & ~bits & 1))));
}

// Two roundings, to double and to float, differ from one only where the first ends in the middle between two
// floats, which is rare, or where the float is subnormal. A branch for these takes less time than vectorised
// loops without it.
inline float emulated_fma(float a, float b, float c) {
  constexpr std::uint64_t kBelow = 0x1fffffff, kMiddle = 0x10000000;  // the bits that a float has not
  constexpr std::uint64_t kLeastNormal = 0x3810000000000000, kNormals = 0x4000000000000000;
  const double product = static_cast<double>(a) * static_cast<double>(b), addend = static_cast<double>(c);
  const double sum = product + addend;
  const std::uint64_t bits = std::bit_cast<std::uint64_t>(sum), size = bits & ~(std::uint64_t{1} << 63);
  if ((bits & kBelow) != kMiddle && (size - kLeastNormal < kNormals || size == 0)) [[likely]]
    return static_cast<float>(sum);
  return fma_by_odd_sum(product, addend);
}

}  // namespace astrolith
