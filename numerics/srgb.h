// Colours as images store them: the transfer function of sRGB (IEC 61966-2-1), and luma.
#pragma once

#include <cstdint>

#include "numerics/portable_double.h"

namespace astrolith {

// The linear light of a gamma-encoded component; both in [0, 1].
inline double srgb_to_linear(double encoded) {
  return encoded <= 0.04045 ? encoded / 12.92 : portable::pow((encoded + 0.055) / 1.055, 2.4);
}

// The gamma-encoded component of linear light; both in [0, 1].
inline double linear_to_srgb(double linear) {
  return linear <= 0.0031308 ? 12.92 * linear : 1.055 * portable::pow(linear, 1.0 / 2.4) - 0.055;
}

// The luma 0.2126 R + 0.7152 G + 0.0722 B of stored values, which have 16 bits, rounded to the nearest.
constexpr std::uint16_t rgb_luma(std::uint32_t red, std::uint32_t green, std::uint32_t blue) {
  return static_cast<std::uint16_t>((2126u * red + 7152u * green + 722u * blue + 5000u) / 10000u);
}

}  // namespace astrolith
