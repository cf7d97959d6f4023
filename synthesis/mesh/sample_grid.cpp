#include "synthesis/mesh/sample_grid.h"

#include <algorithm>
#include <cmath>
#include <string>

#include "numerics/errors.h"
#include "numerics/interval.h"

namespace astrolith {
namespace {

// Vertices stay 2^-10 of the edge of a cell away from its ends. This margin must exceed the rounding error of
// a position.
void check_positions_are_distinct(const Box& bounds, double step) {
  const double rounding = 0x1.0p-23 * largest_coordinate(bounds);
  if (step * 0x1.0p-10 <= rounding) {
    throw InputError("resolution: cells of " + std::to_string(step) +
                     " are too small for 32-bit positions this far from the origin; lower the resolution");
  }
}

void check_resolution(int resolution) {
  if (resolution < kMinResolution || resolution > kMaxResolution) {
    throw InputError("resolution: " + std::to_string(resolution) + " is outside " +
                     std::to_string(kMinResolution) + " .. " + std::to_string(kMaxResolution));
  }
}

}  // namespace

SampleGrid make_sample_grid(const Box& bounds, int resolution) {
  check_resolution(resolution);
  const double longest = bounds.longest_side();
  if (bounds.empty() || !(longest > 0.0) || !std::isfinite(longest)) {
    throw InputError("bounds: the body has no extent to sample; check its spheres");
  }
  SampleGrid grid;
  grid.step = longest / (resolution - 2);
  check_positions_are_distinct(bounds, grid.step);
  const auto cells_along = [&](double length) {
    return std::clamp(static_cast<int>(std::ceil(length / grid.step - 1e-6)), 1, resolution - 2) + 2;
  };
  const Vec3d extent = bounds.extent();
  grid.cells = {cells_along(extent.x), cells_along(extent.y), cells_along(extent.z)};
  grid.origin = bounds.center() -
                0.5 * grid.step * Vec3d{double(grid.cells[0]), double(grid.cells[1]), double(grid.cells[2])};
  return grid;
}

SampleGrid make_patch_grid(double size, int resolution) {
  check_resolution(resolution);
  if (!(size > 0.0) || !std::isfinite(size)) throw InputError("patch: its size must be a length above 0");
  SampleGrid grid;
  grid.step = size / resolution;
  grid.cells = {resolution + 1, resolution + 1, resolution + 1};
  const double first = -0.5 * size - grid.step;
  grid.origin = {first, first, first};
  return grid;
}

CellWindow patch_window(const SampleGrid& grid) { return {{2, 2, 2}, grid.cells}; }

}  // namespace astrolith
