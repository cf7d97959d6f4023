#include "geometry/surface/footprint_planes.h"

#include <cmath>
#include <cstddef>
#include <cstdint>
#include <limits>

#include "numerics/parallel_for.h"

namespace astrolith {
namespace {

// Sums over the pixels of a square, or over its part in one row: of the heights z, of their squares, and of
// their products with columns x and rows y counted from the middle.
struct HeightMoments {
  double z = 0.0, zz = 0.0, xz = 0.0, yz = 0.0;
};

HeightMoments of_row(const float* middle, int half) {
  HeightMoments sums;
  for (int x = -half; x <= half; ++x) {
    const double z = middle[x];
    sums.z += z, sums.zz += z * z, sums.xz += x * z;
  }
  return sums;
}

FootprintPlane plane_of(const HeightMoments& sums, int half, double pixel) {
  const double side = 2.0 * half + 1.0, count = side * side;
  const double spread = (side * side - 1.0) / 12.0;  // mean square of x, and of y
  const double mean = sums.z / count, x = sums.xz / (count * spread), y = sums.yz / (count * spread);
  const double square = sums.zz / count - mean * mean - spread * (x * x + y * y);
  // Rows run down, and rounding leaves less than nothing on a plane.
  return {static_cast<float>(x / pixel), static_cast<float>(-y / pixel),
          static_cast<float>(std::sqrt(square < 0.0 ? 0.0 : square))};
}

}  // namespace

std::vector<FootprintPlane> footprint_planes(const HeightMap& map, int half) {
  const auto side = static_cast<std::size_t>(map.side), reach = static_cast<std::size_t>(half);
  constexpr float kNone = std::numeric_limits<float>::quiet_NaN();
  std::vector<FootprintPlane> planes(side * side, {kNone, kNone, kNone});
  if (side < 2 * reach + 1) return planes;
  std::vector<HeightMoments> rows(side * side);
  parallel_for(0, map.side, [&](std::int64_t j) {
    for (std::size_t i = reach; i + reach < side; ++i) {
      const std::size_t at = static_cast<std::size_t>(j) * side + i;
      rows[at] = of_row(map.heights.data() + at, half);
    }
  });
  parallel_for(half, map.side - half, [&](std::int64_t j) {
    for (std::size_t i = reach; i + reach < side; ++i) {
      HeightMoments sums;
      for (int y = -half; y <= half; ++y) {
        const HeightMoments& row = rows[static_cast<std::size_t>(j + y) * side + i];
        sums.z += row.z, sums.zz += row.zz, sums.xz += row.xz, sums.yz += y * row.z;
      }
      planes[static_cast<std::size_t>(j) * side + i] = plane_of(sums, half, map.pixel);
    }
  });
  return planes;
}

}  // namespace astrolith
