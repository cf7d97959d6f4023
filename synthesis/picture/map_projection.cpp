#include "synthesis/picture/map_projection.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "numerics/portable_angles.h"

namespace astrolith {
double map_width(MapProjection projection) {
  return projection == MapProjection::kEquirectangular ? 2.0 : 1.0;
}

std::optional<Vec3d> map_direction(MapProjection projection, double x, double y) {
  if (projection == MapProjection::kEquirectangular) {
    if (std::fabs(x) > 2.0 || std::fabs(y) > 1.0) return std::nullopt;
    const portable::SineCosine longitude = portable::sine_and_cosine(0.5 * std::numbers::pi * x),
                               latitude = portable::sine_and_cosine(0.5 * std::numbers::pi * y);
    return Vec3d{latitude.cosine * longitude.cosine, latitude.cosine * longitude.sine, latitude.sine};
  }
  const double square = 2.0 * (x * x + y * y);  // of the chord from the middle
  if (square > 2.0) return std::nullopt;
  const double across = std::sqrt(2.0 * (1.0 - 0.25 * square));
  return Vec3d{1.0 - 0.5 * square, across * x, across * y};
}

std::optional<std::pair<double, double>> map_place(MapProjection projection, const Vec3d& direction) {
  const Vec3d d = normalized(direction);
  if (projection == MapProjection::kEquirectangular) {
    const double across = std::sqrt(d.x * d.x + d.y * d.y);
    return std::pair(portable::atan2(d.y, d.x) / (0.5 * std::numbers::pi),
                     portable::atan2(d.z, across) / (0.5 * std::numbers::pi));
  }
  if (d.x < 0.0) return std::nullopt;
  const double scale = 1.0 / std::sqrt(1.0 + d.x);
  return std::pair(scale * d.y, scale * d.z);
}

}  // namespace astrolith
