// Points at which surface noise is evaluated, put in an order in which neighbours in number are neighbours in
// space, and what of a bandwidth's impulses reaches them.
#pragma once

#include <cstdint>
#include <vector>

#include "synthesis/gabor/gabor_tiles.h"

namespace astrolith {

// Cells first .. last along x, y, z.
struct CellRange {
  std::array<int, 3> first, last;

  std::int64_t cells() const {
    const auto size = [&](std::size_t axis) { return std::int64_t{last[axis]} - first[axis] + 1; };
    return size(0) * size(1) * size(2);
  }
};

class GaborSurfacePoints {
 public:
  // Copies the points; `with_slopes` asks for slopes as well.
  GaborSurfacePoints(int n, const float* x, const float* y, const float* z, bool with_slopes);

  // Adds the noise of one bandwidth. The bits of a point's sums depend on the point alone.
  void add_band(const GaborTiles& tiles);

  // The sums of the points in their order of the constructor, as arrays of n floats.
  void store_heights(float* height) const;
  void store_slopes(float* x, float* y, float* z) const;

 private:
  int size() const { return static_cast<int>(index_.size()); }
  void sort(int begin, int end);
  PointBox box_of(int begin, int end) const;
  HeightSums sums_from(int begin);
  bool whole_groups(int begin, int end) const;
  void add_band(const GaborTiles& tiles, int begin, int end);
  void add_to_scattered(const GaborTiles& tiles, const CellRange& range, int begin, int end);
  void add_to_dense(const GaborTiles& tiles, const CellRange& range, int begin, int end);

  std::vector<int> index_;                    // where each point was
  std::vector<float> x_, y_, z_;              // whole groups: the last is filled up with its last point
  std::vector<float> height_, sx_, sy_, sz_;  // sums; slopes are empty where not wanted
};

}  // namespace astrolith
