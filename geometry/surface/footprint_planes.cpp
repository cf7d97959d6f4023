#include "geometry/surface/height_map.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <limits>

#include "numerics/parallel_for.h"

namespace astrolith {
namespace {

__extension__ using Wide = __int128;

// Heights as whole numbers: sums of them are exact in any order, so that a running sum drifts nowhere.
// Numbers of 30 bits are finer than the floats. A square of 2^15 pixels a side has moments below 2^122.
class WholeHeights {
 public:
  explicit WholeHeights(const std::vector<float>& heights) {
    float least = std::numeric_limits<float>::max(), most = std::numeric_limits<float>::lowest();
    for (const float z : heights) {
      if (std::isfinite(z)) least = std::min(least, z), most = std::max(most, z);
    }
    if (!(most > least)) return;
    middle_ = 0.5 * (double{least} + double{most});
    int exponent = 0;
    std::frexp(most - middle_, &exponent);
    exponent_ = kBits - exponent;
  }
  std::int64_t number(float height) const { return std::llround(std::ldexp(height - middle_, exponent_)); }
  // The height units of one.
  double unit() const { return std::ldexp(1.0, -exponent_); }

 private:
  static constexpr int kBits = 30;
  double middle_ = 0.0;
  int exponent_ = 0;
};

// Sums over pixels, without the middle height: of the heights z, of their squares, and of their products with
// rows and columns of the map.
struct HeightMoments {
  Wide zz = 0, row_z = 0, column_z = 0;
  std::int64_t z = 0, missing = 0;

  void add(const HeightMoments& m, std::int64_t column, int sign) {
    zz += sign * m.zz, row_z += sign * m.row_z, column_z += sign * Wide{column} * m.z;
    z += sign * m.z, missing += sign * m.missing;
  }
};

FootprintPlane fit_plane(const HeightMoments& sums, std::int64_t row, std::int64_t column, int half,
                         double unit, double pixel) {
  const std::int64_t side = 2 * half + 1, count = side * side;
  // The variance of x, and of y, from the middle of the square.
  const double n = static_cast<double>(count), spread = static_cast<double>(count - 1) / 12.0;
  const double x = static_cast<double>(sums.column_z - column * Wide{sums.z}) / (n * spread),
               y = static_cast<double>(sums.row_z - row * Wide{sums.z}) / (n * spread);
  const double variance = static_cast<double>(count * sums.zz - Wide{sums.z} * sums.z) / (n * n);
  const double square = variance - spread * (x * x + y * y);
  // Rows run down, and rounding leaves less than nothing on a plane.
  return {static_cast<float>(unit * x / pixel), static_cast<float>(-unit * y / pixel),
          static_cast<float>(unit * std::sqrt(square < 0.0 ? 0.0 : square))};
}

// Makes the planes of one row after another. Each column has the sums over the rows of the square.
class PlaneRow {
 public:
  PlaneRow(const HeightMap& map, const WholeHeights& whole, int half)
      : map_(map), whole_(whole), half_(half), columns_(static_cast<std::size_t>(map.side)) {}

  void add_row(std::int64_t row, int sign) {
    const float* const heights = map_.heights.data() + row * map_.side;
    for (std::size_t i = 0; i < columns_.size(); ++i) {
      HeightMoments& column = columns_[i];
      if (!std::isfinite(heights[i])) {
        column.missing += sign;
        continue;
      }
      const std::int64_t z = whole_.number(heights[i]);
      column.zz += sign * Wide{z} * z, column.row_z += sign * row * z, column.z += sign * z;
    }
  }

  // Fills what is known of the row of planes whose squares have been added.
  void make(std::int64_t row, FootprintPlane* planes) const {
    HeightMoments square;
    for (std::int64_t last = 0; last < map_.side; ++last) {
      square.add(columns_[static_cast<std::size_t>(last)], last, 1);
      const std::int64_t first = last - 2 * half_, middle = last - half_;
      if (first < 0) continue;
      if (square.missing == 0)
        planes[middle] = fit_plane(square, row, middle, half_, whole_.unit(), map_.pixel);
      square.add(columns_[static_cast<std::size_t>(first)], first, -1);
    }
  }

 private:
  const HeightMap& map_;
  const WholeHeights& whole_;
  int half_;
  std::vector<HeightMoments> columns_;
};

}  // namespace

std::vector<FootprintPlane> footprint_planes(const HeightMap& map, int half) {
  const std::int64_t side = map.side, footprint = 2 * std::int64_t{half} + 1, rows = side - footprint + 1;
  constexpr float kNone = std::numeric_limits<float>::quiet_NaN();
  std::vector<FootprintPlane> planes(map.heights.size(), {kNone, kNone, kNone});
  const WholeHeights whole(map.heights);
  // A band of rows begins with a whole footprint of rows, which costs at most what four bands cost.
  const std::int64_t band = std::max<std::int64_t>(64, footprint / 4);
  parallel_for(0, rows > 0 ? (rows + band - 1) / band : 0, [&](std::int64_t b) {
    PlaneRow squares(map, whole, half);
    const std::int64_t first = b * band, end = std::min(first + band, rows);
    for (std::int64_t row = first; row + 1 < first + footprint; ++row) squares.add_row(row, 1);
    for (std::int64_t top = first; top < end; ++top) {
      squares.add_row(top + footprint - 1, 1);
      squares.make(top + half, planes.data() + (top + half) * side);
      squares.add_row(top, -1);
    }
  });
  return planes;
}

}  // namespace astrolith
