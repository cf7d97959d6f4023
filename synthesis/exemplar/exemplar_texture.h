// The Gaussianised image of an exemplar layer as plain tables, and its value at a point of the image. The
// code is plain and scalar, for loops and GPUs.
//
// The grey values of the image, by their ranks, become samples of a normal distribution: the Gaussianised
// image. g is the quadratic B-spline, which is C1, that has the power of these samples at each frequency. It
// passes near them, and through them where the image is smooth. The coefficients of the spline are whole
// numbers of ten bits, three neighbours of a row in one word, so that nine coefficients take three loads.
#pragma once

#include <cstdint>
#include <vector>

#include "numerics/arrays.h"
#include "numerics/host_device.h"
#include "numerics/scalar_math.h"
#include "recipe/noise_layers.h"

namespace astrolith {

inline constexpr int kExemplarCodeBits = 10;
inline constexpr std::uint32_t kExemplarCodeMask = (1u << kExemplarCodeBits) - 1u;
// The code of the coefficient 0.
inline constexpr float kExemplarZeroCode = 512.0f;

// The table of heights holds coefficients of a quadratic spline over z from -kLargestExemplarDeviation to
// kLargestExemplarDeviation. Beyond these the height stays that of the border.
inline constexpr float kLargestExemplarDeviation = 5.0f;
inline constexpr int kExemplarHeights = 1024;  // number of intervals of the table

struct ExemplarTexture {
  float width = 0.0f, height = 0.0f;       // pixels
  float period_x = 0.0f, period_y = 0.0f;  // pixels: a side, or two where the image is mirrored
  float inverse_period_x = 0.0f, inverse_period_y = 0.0f;
  std::int32_t columns = 0;            // words in a row
  float unit = 0.0f;                   // value of a code above the code of 0
  ArrayRange<std::uint32_t> words;     // (height + 2) rows of `columns` words; the first row is row -1
  ArrayRange<float> heights;           // (kExemplarHeights + 3) coefficients, length units
  double least = 0.0, greatest = 0.0;  // bounds of the heights, length units
};

// Makes the tables of a layer whose heights have the layer's height_rms or height_range, mean 0. The mean
// square of g over the image is 1. Expects sides of kLeastExemplarSide to kMostExemplarSide. Throws
// InputError, which begins with `place`, where the layer has no pixels and where all of them have one grey
// value.
ExemplarTexture make_exemplar_texture(const ExemplarLayer& layer, const std::string& place,
                                      ArrayStore& arrays);

// The standard deviation of the heights of a layer, length units. Expects a layer with pixels.
double exemplar_height_rms(const ExemplarLayer& layer);

// The weights of the three coefficients next to a point, which lies d in [-1/2, 1/2] from the middle one.
struct SplineWeights {
  float below, at, above;
};
ASTROLITH_KERNEL SplineWeights spline_weights(float d) {
  const float below = 0.5f - d, above = 0.5f + d;
  return {0.5f * below * below, math::fma(-d, d, 0.75f), 0.5f * above * above};
}

// One row of three codes, weighted.
ASTROLITH_KERNEL float spline_row(std::uint32_t word, const SplineWeights& w) {
  const auto code = [](std::uint32_t bits) { return static_cast<float>(static_cast<std::int32_t>(bits)); };
  return math::fma(w.below, code(word & kExemplarCodeMask),
                   math::fma(w.at, code((word >> kExemplarCodeBits) & kExemplarCodeMask),
                             w.above * code(word >> (2 * kExemplarCodeBits))));
}

// A pixel and the offset of a point from its middle.
struct PixelPlace {
  float number, offset;
};
// The second half of a period of two sides is the mirror image of the first. In a period of one side, the
// fold changes nothing but the last bits.
ASTROLITH_KERNEL PixelPlace pixel_place(float u, float side, float period, float inverse_period) {
  const float repeated = math::fma(-period, math::floor(u * inverse_period), u);
  const float inside = side - math::abs(repeated - side);
  const float number = math::clamp(math::floor(inside), 0.0f, side - 1.0f);
  return {number, inside - number - 0.5f};
}

// g at the point (u, v), in pixels from the upper left corner of the image. Standard deviation 1.
ASTROLITH_KERNEL float exemplar_value(const ExemplarTexture& t, const std::uint32_t* words, float u,
                                      float v) {
  const PixelPlace x = pixel_place(u, t.width, t.period_x, t.inverse_period_x),
                   y = pixel_place(v, t.height, t.period_y, t.inverse_period_y);
  const SplineWeights wx = spline_weights(x.offset), wy = spline_weights(y.offset);
  const std::int32_t first =
      static_cast<std::int32_t>(y.number) * t.columns + static_cast<std::int32_t>(x.number);
  const float sum = math::fma(wy.below, spline_row(words[first], wx),
                              math::fma(wy.at, spline_row(words[first + t.columns], wx),
                                        wy.above * spline_row(words[first + 2 * t.columns], wx)));
  return t.unit * (sum - kExemplarZeroCode);
}

// The height at the normal deviate z, length units.
ASTROLITH_KERNEL float exemplar_height(const float* heights, float z) {
  constexpr float kPerDeviation = static_cast<float>(kExemplarHeights) / (2.0f * kLargestExemplarDeviation);
  const float inside = math::clamp(z, -kLargestExemplarDeviation, kLargestExemplarDeviation);
  const float at = math::fma(inside, kPerDeviation, 0.5f * static_cast<float>(kExemplarHeights));
  const float number = math::floor(at + 0.5f);
  const SplineWeights w = spline_weights(at - number);
  const auto i = static_cast<std::int32_t>(number);
  return math::fma(w.below, heights[i], math::fma(w.at, heights[i + 1], w.above * heights[i + 2]));
}

}  // namespace astrolith
