// Colours for numbers: a sequential scale on which equal steps look equal.
#pragma once

#include <span>
#include <vector>

#include "numerics/vec3.h"

namespace astrolith {

// The colour for t in [0, 1] (clamped), in linear-light sRGB components in [0, 1]: from dark violet over teal
// to pale yellow. Lightness in OKLab (Ottosson 2020) rises linearly with t, hue falls linearly, and chroma
// stays in gamut.
Vec3<float> sequential_color(double t);

// One colour for each value: sequential_color((value - low) / (high - low)), low < high. NaN gives grey.
std::vector<Vec3<float>> sequential_colors(std::span<const double> values, double low, double high);

// Converts one component from linear light in [0, 1] (clamped) to sRGB in [0, 255].
unsigned char srgb_byte(float linear);

}  // namespace astrolith
