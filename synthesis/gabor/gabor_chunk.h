// Impulses of surface noise in chunks of sixteen, and the loops that add their kernels to heights. Each
// member of the impulses of a chunk is one vector of the widest machine. A single point evaluates sixteen
// impulses at once; a group of sixteen points evaluates one impulse after another.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "synthesis/gabor/gabor_draw.h"

namespace astrolith {

inline constexpr std::size_t kLanes = 16;

struct ImpulseChunk {
  static constexpr std::size_t kMembers = sizeof(GaborImpulse) / sizeof(float);

  // Member k of impulse i is at k * kLanes + i; members have the order of GaborImpulse. Empty lanes hold an
  // impulse whose kernel is 0 at every possible point.
  std::array<float, kMembers * kLanes> members;
  // A box that holds the supports of all impulses.
  std::array<float, 3> low, high;
};

// Puts an impulse into a lane of a chunk, 0 .. kLanes - 1. The box of the chunk stays as it is.
void set_lane(const GaborImpulse& impulse, std::size_t lane, ImpulseChunk& chunk);
// Fills the lanes from `first` on with impulses whose kernels are 0 at every possible point.
void empty_lanes(std::size_t first, ImpulseChunk& chunk);

// The impulses in chunks, in the given order. `a` is their bandwidth, cycles per length unit.
std::vector<ImpulseChunk> make_chunks(std::span<const GaborImpulse> impulses, double a);

// The float points between low and high along each axis.
struct PointBox {
  std::array<float, 3> low, high;
};

inline bool overlap(const PointBox& box, const std::array<float, 3>& low, const std::array<float, 3>& high) {
  return box.low[0] <= high[0] && box.low[1] <= high[1] && box.low[2] <= high[2] && low[0] <= box.high[0] &&
         low[1] <= box.high[1] && low[2] <= box.high[2];
}

// The target that holds the points of a box.
GaborTarget make_target(const PointBox& box, float a);

// Up to sixteen groups of points. Each group lies in a box about its centre, and within a radius of it.
struct GroupBoxes {
  std::size_t count = 0;
  std::array<float, kLanes> x{}, y{}, z{};                 // centres
  std::array<float, kLanes> half_x{}, half_y{}, half_z{};  // half the sides of the boxes
  std::array<float, kLanes> disc{};                        // most_disc() of the radii
};

// The points that heights and slopes are added to: kLanes for each group. The slopes are null if they are not
// wanted.
struct HeightSums {
  const float *x, *y, *z;
  float *height, *slope_x, *slope_y, *slope_z;
};

// Adds amplitude times the kernels of the chunks to the sums at the points of the groups. Impulses that reach
// no point of `target`, or no point of a group, are left out there: their kernels are 0. The kernels are
// added one after another, in their order.
void add_to_groups(std::span<const ImpulseChunk* const> chunks, float a, float amplitude,
                   const GaborTarget& target, const GroupBoxes& groups, const HeightSums& sums);

// Adds amplitude times each kernel of whole chunks to the sums at one point. The bits are those of
// add_to_groups().
void add_at_point(std::span<const ImpulseChunk> chunks, float a, float amplitude, const HeightSums& sums);

}  // namespace astrolith
