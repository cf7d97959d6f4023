// The impulses of one bandwidth of surface noise (gabor_surface_noise.h) that reach some points.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <vector>

#include "synthesis/gabor_tiles.h"

namespace astrolith {

// Cells first .. last along x, y, z.
struct CellRange {
  std::array<int, 3> first, last;

  int size(std::size_t axis) const { return last[axis] - first[axis] + 1; }
  std::int64_t cells() const { return std::int64_t{size(0)} * size(1) * size(2); }
};

// The cells whose impulses may reach a point of the box.
CellRange cells_around(const SurfaceBand& band, const Box& box);

// The impulses that reach any of some points, in the order of their cells (z, then y, then x).
class GaborImpulses {
 public:
  GaborImpulses(const GaborTiles& tiles, int n, const float* x, const float* y, const float* z);

  const std::vector<GaborImpulse>& all() const { return impulses_; }
  // How many points a cell serves on average: few where kernels are small beside the points' spacing.
  double points_per_cell() const;

  // height[i] += the sum of the kernels over the cells around point i, for the points of the constructor.
  // The same bits as adding all impulses one by one.
  void add_by_cells(float* height) const;

 private:
  void collect_tiles(const GaborTiles& tiles);
  void append(const DrawnCells& tile, std::size_t begin, std::size_t end);
  void mark_cells();
  void draw_marked(const PreparedBody& body);
  Vec3d largest_half_extents() const;
  std::size_t row(int cy, int cz) const;  // where a row of cells along x begins

  const SurfaceBand& band_;
  int n_;
  const float *x_, *y_, *z_;
  CellRange range_;
  std::vector<CellRange> around_;     // each point
  std::vector<std::uint32_t> start_;  // by cell: its first impulse; marks before there are impulses
  std::vector<GaborImpulse> impulses_;
  std::int64_t drawn_ = 0;  // cells
};

}  // namespace astrolith
