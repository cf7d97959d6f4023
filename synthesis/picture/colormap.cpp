#include "synthesis/picture/colormap.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "numerics/portable_angles.h"
#include "numerics/portable_double.h"
#include "numerics/srgb.h"

namespace astrolith {
namespace {

// OKLab to linear sRGB, matrices of Ottosson, "A perceptual color space for image processing", 2020.
Vec3<float> oklab_to_linear(double lightness, double a, double b) {
  const double l = portable::whole_power(lightness + 0.3963377774 * a + 0.2158037573 * b, 3);
  const double m = portable::whole_power(lightness - 0.1055613458 * a - 0.0638541728 * b, 3);
  const double s = portable::whole_power(lightness - 0.0894841775 * a - 1.2914855480 * b, 3);
  return {static_cast<float>(4.0767416621 * l - 3.3077115913 * m + 0.2309699292 * s),
          static_cast<float>(-1.2684380046 * l + 2.6097574011 * m - 0.3413193965 * s),
          static_cast<float>(-0.0041960863 * l - 0.7034186147 * m + 1.7076147010 * s)};
}

bool in_gamut(const Vec3<float>& c) {
  return std::min({c.x, c.y, c.z}) >= 0.0f && std::max({c.x, c.y, c.z}) <= 1.0f;
}

}  // namespace

Vec3<float> sequential_color(double t) {
  const double u = std::clamp(t, 0.0, 1.0);
  const double lightness = 0.30 + 0.63 * u;
  const double hue = (300.0 - 195.0 * u) * std::numbers::pi / 180.0;
  // The most vivid colour of this lightness and hue that a screen can show, up to a chroma of 0.15.
  double low = 0.0, high = 0.15;
  for (int i = 0; i < 20; ++i) {
    const double chroma = 0.5 * (low + high);
    (in_gamut(oklab_to_linear(lightness, chroma * portable::cos(hue), chroma * portable::sin(hue))) ? low
                                                                                                    : high) =
        chroma;
  }
  return oklab_to_linear(lightness, low * portable::cos(hue), low * portable::sin(hue));
}

std::vector<Vec3<float>> sequential_colors(std::span<const double> values, double low, double high) {
  std::vector<Vec3<float>> colors;
  colors.reserve(values.size());
  for (const double value : values) {
    const double t = (value - low) / (high - low);
    colors.push_back(std::isnan(t) ? Vec3<float>{0.2f, 0.2f, 0.2f} : sequential_color(t));
  }
  return colors;
}

unsigned char srgb_byte(float linear) {
  return static_cast<unsigned char>(255.0 * linear_to_srgb(std::clamp(double{linear}, 0.0, 1.0)) + 0.5);
}

}  // namespace astrolith
