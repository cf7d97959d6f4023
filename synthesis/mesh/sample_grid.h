// The cubic lattice on which a field is sampled. The position of a sample depends on its index alone and
// never on the block it is computed in. Any division into blocks therefore gives the same bits.
#pragma once

#include <array>

#include "numerics/host_device.h"
#include "numerics/vec3.h"

namespace astrolith {

struct SampleGrid {
  Vec3d origin;              // position of sample (0, 0, 0)
  double step = 1.0;         // edge of a cell, length units
  std::array<int, 3> cells;  // number along x, y, z; there is one more sample than cells

  ASTROLITH_HD float x(int index) const { return static_cast<float>(origin.x + step * index); }
  ASTROLITH_HD float y(int index) const { return static_cast<float>(origin.y + step * index); }
  ASTROLITH_HD float z(int index) const { return static_cast<float>(origin.z + step * index); }

  // The box of the samples first .. last, widened by margin (length units) on every side.
  ASTROLITH_HD Box box(const std::array<int, 3>& first, const std::array<int, 3>& last, double margin) const {
    const Vec3d m{margin, margin, margin};
    const Vec3d low{step * first[0], step * first[1], step * first[2]},
        high{step * last[0], step * last[1], step * last[2]};
    return {origin + low - m, origin + high + m};
  }
};

// The cells that are meshed, first .. last along each axis, named by the samples at their upper corners. A
// window that does not fill its grid has an open mesh.
struct CellWindow {
  std::array<int, 3> first, last;
};

inline constexpr int kMinResolution = 4;
inline constexpr int kMaxResolution = 8192;

// A grid of `resolution` cells along the longest side of `bounds`. One cell at each end lies outside
// `bounds`, so that a surface within `bounds` never touches the border. Throws InputError when `bounds` are
// empty or not finite, when the resolution is outside [kMinResolution, kMaxResolution], and when neighbouring
// positions could not be told apart in 32-bit floats.
SampleGrid make_sample_grid(const Box& bounds, int resolution);

// A grid over a cube of side `size` around the origin, with `resolution` cells along its sides. One more
// layer of cells below each lower side owns the samples in that side; patch_window leaves this layer out.
// Throws InputError when the size is not positive and finite or the resolution is out of range.
SampleGrid make_patch_grid(double size, int resolution);
CellWindow patch_window(const SampleGrid& grid);

}  // namespace astrolith
