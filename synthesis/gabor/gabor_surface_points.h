// The points at which surface noise is evaluated. They are sorted so that points with neighbouring numbers
// lie close together, which makes it cheap to find the impulses that reach them.
#pragma once

#include <cstdint>
#include <vector>

#include "synthesis/gabor/gabor_bricks.h"

namespace astrolith {

// The cells first to last along x, y and z.
struct CellRange {
  std::array<int, 3> first, last;

  std::int64_t cells() const {
    const auto size = [&](std::size_t axis) { return std::int64_t{last[axis]} - first[axis] + 1; };
    return size(0) * size(1) * size(2);
  }
};

class GaborSurfacePoints {
 public:
  // Copies n points. The slopes of the noise are computed only if `with_slopes` is set.
  GaborSurfacePoints(int n, const float* x, const float* y, const float* z, bool with_slopes);

  // Adds the noise of one bandwidth. The bits of the sums at a point depend on this point alone.
  void add_band(const GaborBricks& bricks);

  // Writes the sums as arrays of n floats, in the order in which the points were given.
  void store_heights(float* height) const;
  void store_slopes(float* x, float* y, float* z) const;

 private:
  int size() const { return static_cast<int>(index_.size()); }
  void sort(int begin, int end);
  PointBox bounding_box(int begin, int end) const;
  HeightSums sums_from(int begin);
  bool whole_groups(int begin, int end) const;
  void add_band(const GaborBricks& bricks, int begin, int end);
  void add_to_scattered(const GaborBricks& bricks, int begin, int end);
  void add_to_dense(const GaborBricks& bricks, const CellRange& cells, int begin, int end);
  void add_chunks(const std::vector<const ImpulseChunk*>& chunks, const SurfaceBand& band, int begin,
                  int end);
  void find_groups();
  GroupBoxes group_boxes(float a, int begin, int end) const;

  // The box of the points of a group, and their greatest distance from its centre.
  struct Group {
    PointBox box;
    float radius;
  };

  std::vector<int> index_;  // number of each point before sorting
  std::vector<Group> groups_;
  std::vector<float> x_, y_, z_;              // whole groups; the last point fills up the last group
  std::vector<float> height_, sx_, sy_, sz_;  // sums; slopes are empty if not wanted
};

}  // namespace astrolith
