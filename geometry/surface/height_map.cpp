#include "geometry/surface/height_map.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace astrolith {
namespace {

// A point in pixels from the upper left corner, and its height.
Vec3d in_pixels(const HeightMap& map, const Vec3d& p) {
  const Vec3d d = p - map.origin;
  return {dot(d, map.right) / map.pixel + 0.5 * map.side, 0.5 * map.side - dot(d, map.ahead) / map.pixel,
          dot(d, map.up)};
}

struct PixelRange {
  int begin, end;
};

// The pixels of a row or column whose centres lie between two places.
PixelRange centers_between(double low, double high, int side) {
  const double begin = std::ceil(low - 0.5), end = std::floor(high - 0.5) + 1.0;
  return {static_cast<int>(std::clamp(begin, 0.0, double(side))),
          static_cast<int>(std::clamp(end, 0.0, double(side)))};
}

void draw(HeightMap& map, const Vec3d& a, const Vec3d& b, const Vec3d& c, double scale) {
  const double area = (b.x - a.x) * (c.y - a.y) - (b.y - a.y) * (c.x - a.x);
  if (area == 0.0) return;
  const PixelRange rows = centers_between(std::min({a.y, b.y, c.y}), std::max({a.y, b.y, c.y}), map.side);
  const PixelRange columns = centers_between(std::min({a.x, b.x, c.x}), std::max({a.x, b.x, c.x}), map.side);
  for (int j = rows.begin; j < rows.end; ++j) {
    for (int i = columns.begin; i < columns.end; ++i) {
      const double x = i + 0.5, y = j + 0.5;
      const double u = ((x - a.x) * (c.y - a.y) - (y - a.y) * (c.x - a.x)) / area;
      const double v = ((b.x - a.x) * (y - a.y) - (b.y - a.y) * (x - a.x)) / area;
      if (u < -1e-12 || v < -1e-12 || u + v > 1.0 + 1e-12) continue;
      const auto height = static_cast<float>(scale * (a.z + u * (b.z - a.z) + v * (c.z - a.z)));
      float& pixel = map.heights[static_cast<std::size_t>(j) * static_cast<std::size_t>(map.side) +
                                 static_cast<std::size_t>(i)];
      if (!(pixel >= height)) pixel = height;
    }
  }
}

}  // namespace

HeightMap height_map(const TriangleMesh& mesh, const GroundPlane& plane, double length, int side,
                     double scale) {
  const auto& [axes, origin] = plane;
  HeightMap map{side, length / side, origin, axes.right, axes.ahead, axes.up, {}};
  const auto pixels = static_cast<std::size_t>(side) * static_cast<std::size_t>(side);
  map.heights.assign(pixels, std::numeric_limits<float>::quiet_NaN());
  for (const auto& [a, b, c] : mesh.triangles) {
    draw(map, in_pixels(map, mesh.vertices[a]), in_pixels(map, mesh.vertices[b]),
         in_pixels(map, mesh.vertices[c]), scale);
  }
  return map;
}

}  // namespace astrolith
