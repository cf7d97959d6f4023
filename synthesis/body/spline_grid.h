// A function in space, as a cubic B-spline over the nodes of a cubic grid, and the signed distance to the
// surface where it is zero. The code is plain, so that CPU and GPU give the same bits.
//
// With the coefficients c_ijk at the nodes p_ijk = first + h (i, j, k) and the B-spline B of order 4,
//   v(p) = sum_ijk c_ijk B((x - x_i) / h) B((y - y_j) / h) B((z - z_k) / h)
// has continuous second derivatives. The first-order distance to its surface, positive inside, is
//   s(p) = v(p) / sqrt(|grad v(p)|^2 + floor)
// within the domain of the spline. Beyond it, s is that of the nearest point of the domain, less the distance
// to this point.
#pragma once

#include <algorithm>
#include <cmath>
#include <cstdint>

#include "numerics/arrays.h"
#include "numerics/host_device.h"
#include "numerics/interval.h"
#include "numerics/scalar_math.h"
#include "numerics/vec3.h"
#include "synthesis/body/body_operators.h"

namespace astrolith {

struct SplineGrid {
  ArrayRange<float> coefficients;  // x fastest, count[0] * count[1] * count[2] of them; length units
  std::int32_t count[3] = {};      // nodes along each axis, at least 4; 0 for no grid
  Vec3f first;                     // place of the first node
  float spacing = 1.0f;            // h
  Vec3f low, high;                 // the domain: from the second node to the last but one

  ASTROLITH_HD bool exists() const { return count[0] != 0; }
  // The largest coordinate in the domain, length units.
  ASTROLITH_HD double size() const {
    return largest_coordinate({{low.x, low.y, low.z}, {high.x, high.y, high.z}});
  }
};

// Added to |grad v|^2, so that s is finite where v is flat, deep inside a body.
inline constexpr float kSplineGradientFloor = 1e-4f;

// The four weights of a cubic B-spline for the coefficients around a share t of a cell, and their
// derivatives.
struct GridWeights {
  float value[4], slope[4];
};
ASTROLITH_KERNEL GridWeights grid_weights(float t) {
  const float u = 1.0f - t, t2 = t * t, u2 = u * u;
  constexpr float kSixth = 1.0f / 6.0f, kTwoThirds = 2.0f / 3.0f;
  return {{kSixth * (u2 * u), math::fma(t2, math::fma(0.5f, t, -1.0f), kTwoThirds),
           math::fma(u2, math::fma(0.5f, u, -1.0f), kTwoThirds), kSixth * (t2 * t)},
          {-0.5f * u2, t * math::fma(1.5f, t, -2.0f), -u * math::fma(1.5f, u, -2.0f), 0.5f * t2}};
}

// The cell of a coordinate q within the domain, and the share of it: nodes cell - 1 .. cell + 2 count.
struct SplineCell {
  std::int32_t cell;
  float share;
};
ASTROLITH_KERNEL SplineCell spline_cell(float q, float first, float spacing, std::int32_t count) {
  const float u = (q - first) / spacing;
  const float last = static_cast<float>(count - 3);
  const float cell = math::clamp(math::floor(u), 1.0f, last);
  return {static_cast<std::int32_t>(cell), u - cell};
}

// v and its gradient at a point of the domain.
struct SplineSample {
  float value;
  Vec3f gradient;
};
ASTROLITH_KERNEL SplineSample spline_sample(const SplineGrid& grid, const float* coefficients,
                                            const Vec3f& q) {
  const SplineCell cx = spline_cell(q.x, grid.first.x, grid.spacing, grid.count[0]),
                   cy = spline_cell(q.y, grid.first.y, grid.spacing, grid.count[1]),
                   cz = spline_cell(q.z, grid.first.z, grid.spacing, grid.count[2]);
  const GridWeights wx = grid_weights(cx.share), wy = grid_weights(cy.share), wz = grid_weights(cz.share);
  const std::int32_t row = grid.count[0], plane = row * grid.count[1];
  const float* corner = coefficients + (cx.cell - 1) + row * (cy.cell - 1) + plane * (cz.cell - 1);
  float v = 0.0f, gx = 0.0f, gy = 0.0f, gz = 0.0f;
  ASTROLITH_UNROLL
  for (int k = 0; k < 4; ++k) {
    float sum = 0.0f, sum_x = 0.0f, sum_y = 0.0f;
    ASTROLITH_UNROLL
    for (int j = 0; j < 4; ++j) {
      const float* c = corner + row * j + plane * k;
      const float along = math::fma(
          wx.value[0], c[0], math::fma(wx.value[1], c[1], math::fma(wx.value[2], c[2], wx.value[3] * c[3])));
      const float rise = math::fma(
          wx.slope[0], c[0], math::fma(wx.slope[1], c[1], math::fma(wx.slope[2], c[2], wx.slope[3] * c[3])));
      sum = math::fma(wy.value[j], along, sum);
      sum_x = math::fma(wy.value[j], rise, sum_x);
      sum_y = math::fma(wy.slope[j], along, sum_y);
    }
    v = math::fma(wz.value[k], sum, v);
    gx = math::fma(wz.value[k], sum_x, gx);
    gy = math::fma(wz.value[k], sum_y, gy);
    gz = math::fma(wz.slope[k], sum, gz);
  }
  return {v, {gx / grid.spacing, gy / grid.spacing, gz / grid.spacing}};
}

// s at p, and the gradient of v over its length.
ASTROLITH_KERNEL BodySample spline_distance(const SplineGrid& grid, const float* coefficients,
                                            const Vec3f& p) {
  const Vec3f q = moved_into(p, grid.low, grid.high), beyond = p - q;
  const auto [v, g] = spline_sample(grid, coefficients, q);
  const float length = math::sqrt(math::fma(g.x, g.x, math::fma(g.y, g.y, g.z * g.z)) + kSplineGradientFloor);
  const float outside =
      math::sqrt(math::fma(beyond.x, beyond.x, math::fma(beyond.y, beyond.y, beyond.z * beyond.z)));
  return {v / length - outside, g.x / length, g.y / length, g.z / length};
}

// The cells along one axis that hold the coordinates low .. high of the domain, widened for rounding.
struct SplineCells {
  std::int32_t first, last;
};
ASTROLITH_HD inline SplineCells spline_cells(double low, double high, float first, float spacing,
                                             std::int32_t count) {
  const double a = (low - double{first}) / double{spacing}, b = (high - double{first}) / double{spacing};
  return {static_cast<std::int32_t>(clamped(std::floor(a - 1e-3), 1.0, count - 3.0)),
          static_cast<std::int32_t>(clamped(std::floor(b + 1e-3), 1.0, count - 3.0))};
}

// The largest and the smallest |v| of an interval.
ASTROLITH_HD inline double largest_size(const Interval& v) {
  return std::max(std::fabs(v.low), std::fabs(v.high));
}
ASTROLITH_HD inline double smallest_size(const Interval& v) {
  return v.low > 0.0 ? v.low : v.high < 0.0 ? -v.high : 0.0;
}

// The least and the largest distance from the domain to a point of a box; points of the domain have 0.
struct DistanceRange {
  double nearest, farthest;
};
ASTROLITH_HD inline DistanceRange distances_beyond(const SplineGrid& grid, const Box& box) {
  const Box domain{{grid.low.x, grid.low.y, grid.low.z}, {grid.high.x, grid.high.y, grid.high.z}};
  const Vec3d none{};
  return {
      norm(component_max(none, component_max(box.min - domain.max, domain.min - box.max))) * (1.0 - 1e-5),
      norm(component_max(none, component_max(box.max - domain.max, domain.min - box.min))) * (1.0 + 1e-5)};
}

// Extends an interval by a value.
ASTROLITH_HD inline void extend(Interval& v, double by) {
  v.low = std::min(v.low, by);
  v.high = std::max(v.high, by);
}

// An interval that holds s for every float point of a box. A B-spline lies within the hull of the
// coefficients that reach the box, and its slopes within the hull of their differences. v also lies within
// its slopes times the half sides of the box of its value at the centre.
ASTROLITH_HD inline Interval bound_spline_distance(const SplineGrid& grid, const float* coefficients,
                                                   const Box& box) {
  constexpr double kInfinity = 1e300;
  const Box at = moved_into(box, grid.low, grid.high);
  const SplineCells x = spline_cells(at.min.x, at.max.x, grid.first.x, grid.spacing, grid.count[0]),
                    y = spline_cells(at.min.y, at.max.y, grid.first.y, grid.spacing, grid.count[1]),
                    z = spline_cells(at.min.z, at.max.z, grid.first.z, grid.spacing, grid.count[2]);
  Interval v{kInfinity, -kInfinity}, gx = v, gy = v, gz = v;
  const std::ptrdiff_t row = grid.count[0], plane = row * grid.count[1];
  for (std::int32_t k = z.first - 1; k <= z.last + 2; ++k) {
    for (std::int32_t j = y.first - 1; j <= y.last + 2; ++j) {
      const float* c = coefficients + row * j + plane * k;
      for (std::int32_t i = x.first - 1; i <= x.last + 2; ++i) {
        const double here = double{c[i]};
        extend(v, here);
        if (i < x.last + 2) extend(gx, double{c[i + 1]} - here);
        if (j < y.last + 2) extend(gy, double{c[i + row]} - here);
        if (k < z.last + 2) extend(gz, double{c[i + plane]} - here);
      }
    }
  }
  const Vec3d slope =
      Vec3d{largest_size(gx), largest_size(gy), largest_size(gz)} * (1.0 / double{grid.spacing});
  const Vec3d flat =
      Vec3d{smallest_size(gx), smallest_size(gy), smallest_size(gz)} * (1.0 / double{grid.spacing});
  const double steepest = std::sqrt(squared_norm(slope) + double{kSplineGradientFloor}),
               flattest = std::sqrt(squared_norm(flat) + double{kSplineGradientFloor});
  const double slack = 2e-6 * (largest_size(v) + steepest * (largest_coordinate(box) + grid.size()));
  const double middle = double{spline_sample(grid, coefficients, to_float(at.center())).value},
               reach = 0.5 * dot(slope, at.extent());
  const double low = std::max(v.low, middle - reach) - slack, high = std::min(v.high, middle + reach) + slack;
  const DistanceRange outside = distances_beyond(grid, box);
  return {
      low / (low > 0.0 ? steepest : flattest) * (low > 0.0 ? 1.0 - 1e-5 : 1.0 + 1e-5) - outside.farthest,
      high / (high > 0.0 ? flattest : steepest) * (high > 0.0 ? 1.0 + 1e-5 : 1.0 - 1e-5) - outside.nearest};
}

}  // namespace astrolith
