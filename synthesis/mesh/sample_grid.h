// The cubic lattice a field is sampled on. A sample's position depends on its index alone, never on the block
// it is computed in, so that any decomposition gives the same bits.
#pragma once

#include <array>

#include "numerics/host_device.h"
#include "numerics/vec3.h"

namespace astrolith {

struct SampleGrid {
  Vec3d origin;              // position of sample (0, 0, 0)
  double step = 1.0;         // edge of a cell, length units
  std::array<int, 3> cells;  // along x, y, z; there is one sample more

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

// The cells that are meshed, by the samples of their upper corners: first .. last along each axis. Around a
// window that does not fill its grid the mesh is open.
struct CellWindow {
  std::array<int, 3> first, last;
};

inline constexpr int kMinResolution = 4;
inline constexpr int kMaxResolution = 8192;

// A grid of `resolution` cells along the longest side of bounds, one cell of it as padding on each end, so
// that a surface within bounds never touches the border. Throws InputError when bounds are empty or not
// finite, the resolution is outside [kMinResolution, kMaxResolution], or neighbouring positions could not be
// told apart in 32-bit floats.
SampleGrid make_sample_grid(const Box& bounds, int resolution);

// A cube of `size` around the origin, `resolution` cells along its sides, with one more cell below each,
// which owns the samples in the cube's lower sides; window_of_patch leaves it out. Throws InputError when the
// size is not positive and finite or the resolution is out of range.
SampleGrid make_patch_grid(double size, int resolution);
CellWindow window_of_patch(const SampleGrid& grid);

}  // namespace astrolith
