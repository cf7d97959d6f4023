// The impulses of one bandwidth of surface noise (gabor_surface_noise.h): which cells of space hold those
// that reach some points, and what they are. They follow from the seed, the cell and the body alone.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <vector>

#include "synthesis/gabor_bands.h"
#include "synthesis/gabor_kernel.h"
#include "synthesis/metaball_body.h"

namespace astrolith {

// A band of a layer at the body's scale.
struct SurfaceBand {
  GaborBand band;
  std::uint32_t seed;
  float a;      // cycles per length unit
  float cell;   // side, length units
  float reach;  // of a kernel from its impulse, length units
  int impulses_per_cell;
  float amplitude;  // of a kernel, length units
  float farthest;   // impulses farther than this from the surface, to first order, are left out; length units
};

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
  GaborImpulses(const SurfaceBand& band, const PreparedMetaballs& body, int n, const float* x, const float* y,
                const float* z);

  const std::vector<GaborImpulse>& all() const { return impulses_; }
  // How many points a cell serves on average: few where kernels are small beside the points' spacing.
  double points_per_cell() const;

  // height[i] += the sum of the kernels over the cells around point i, for the points of the constructor.
  // The same bits as adding all impulses one by one.
  void add_by_cells(float* height) const;

 private:
  void mark_cells();
  void draw_cells(const PreparedMetaballs& body);
  Vec3d largest_half_extents() const;
  std::size_t row(int cy, int cz) const;  // where a row of cells along x begins

  const SurfaceBand& band_;
  int n_;
  const float *x_, *y_, *z_;
  CellRange range_;
  std::vector<CellRange> around_;     // each point
  std::vector<std::uint32_t> start_;  // by cell: its first impulse; marks before there are impulses
  std::vector<GaborImpulse> impulses_;
  std::int64_t marked_ = 0;
};

}  // namespace astrolith
