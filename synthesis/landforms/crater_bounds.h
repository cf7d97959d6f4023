// Bounds of the relief of craters over a box, for CPU and GPU.
#pragma once

#include "numerics/interval.h"
#include "synthesis/body/metaball_box.h"
#include "synthesis/landforms/crater_profile.h"

namespace astrolith {

inline constexpr double kCraterSlack = 1e-5;  // relative rounding of positions and heights

// A box outside of which a crater changes no elevation.
ASTROLITH_HD inline Box crater_reach(const CraterKernel& c) {
  const double reach =
      std::sqrt(double{c.extent_squared} / double{c.inverse_radius_squared}) * (1.0 + kCraterSlack);
  const Vec3d center{double{c.x}, double{c.y}, double{c.z}};
  const Box box{center, center};
  return widened(box, reach + 1e-6 * largest_coordinate(box));
}

// Bounds of x^2 over a box, with x = distance from the centre / radius.
ASTROLITH_HD inline Interval crater_squares(const CraterKernel& c, const Box& box) {
  const MetaballSphere<float> sphere{{c.x, c.y, c.z}, 0.0f};
  const SquaredDistances range = squared_distances(sphere, box);
  const double scale = double{c.inverse_radius_squared};
  const double rounding = 2e-6 * std::sqrt(scale) * largest_coordinate(box);  // rounding of x
  const double near = std::max(0.0, std::sqrt(range.nearest * scale) * (1.0 - kCraterSlack) - rounding);
  const double far = std::sqrt(range.farthest * scale) * (1.0 + kCraterSlack) + rounding;
  return {near * near, far * far};
}

// Bounds of crater_height(). The cavity rises with x, while rim and peak fall with x.
ASTROLITH_HD inline Interval bound_crater_height(const CraterKernel& c, const Interval& x_squared) {
  const float low = static_cast<float>(x_squared.low), high = static_cast<float>(x_squared.high);
  const float cavity_low = crater_cavity(c, low), cavity_high = crater_cavity(c, high);
  const float rim_low = crater_rim(c, high), rim_high = crater_rim(c, low);
  const double k = double{c.smoothing} / 4.0, floor = -double{c.depth};
  const double pit_low =
      double{math::min(math::min(cavity_low, rim_high), math::min(cavity_high, rim_low))} - k;
  const double pit_high = double{math::min(math::min(cavity_high, rim_high), c.rim_height)};
  const double peak_low = double{crater_peak(c, high)}, peak_high = double{crater_peak(c, low)};
  const double slack = kCraterSlack * (double{c.depth} + double{c.rim_height} + double{c.peak_height});
  const Interval height{std::max(pit_low, floor) + peak_low - slack,
                        std::max(pit_high, floor) + k + peak_high + slack};
  if (high < c.extent_squared) return height;
  return {std::min(height.low, 0.0), std::max(height.high, 0.0)};
}

// Bounds of cratered() over a box, from bounds of the elevations before the crater.
ASTROLITH_HD inline Interval bound_cratered(const CraterKernel& c, const Box& box, const Interval& before) {
  const Interval x_squared = crater_squares(c, box);
  const double least = std::min(x_squared.low, 1.0), most = std::min(x_squared.high, 1.0);
  const double base = double{c.base};
  const Interval height = bound_crater_height(c, x_squared);
  const double slack =
      kCraterSlack * (std::fabs(base) + std::max(std::fabs(before.low), std::fabs(before.high)));
  const auto kept = [&](double elevation, double share) { return base + (elevation - base) * share; };
  return {std::min(kept(before.low, least), kept(before.low, most)) + height.low - slack,
          std::max(kept(before.high, least), kept(before.high, most)) + height.high + slack};
}

}  // namespace astrolith
