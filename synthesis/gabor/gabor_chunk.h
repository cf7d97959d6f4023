// Impulses of surface noise in chunks of sixteen, and the loops that add their kernels to heights. Each
// member of the impulses of a chunk is one vector of the widest machine. A single point evaluates sixteen
// impulses at once; a group of sixteen points evaluates one impulse after another.
#pragma once

#include <array>
#include <cstddef>
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

// A pointer to the first member of one impulse in a chunk. Its other members follow at steps of kLanes.
using ImpulseLane = const float*;
ASTROLITH_KERNEL GaborImpulse impulse_at(ImpulseLane lane) {
  constexpr std::size_t k = kLanes;
  return {lane[0],      lane[k],      lane[2 * k],  lane[3 * k],  lane[4 * k],
          lane[5 * k],  lane[6 * k],  lane[7 * k],  lane[8 * k],  lane[9 * k],
          lane[10 * k], lane[11 * k], lane[12 * k], lane[13 * k], lane[14 * k]};
}

// Appends the impulses of the chunks whose kernels may reach the box, in their order. An impulse whose kernel
// reaches the box is never left out.
void append_reaching(std::span<const ImpulseChunk* const> chunks, const PointBox& box,
                     std::vector<ImpulseLane>& lanes);

// The arrays that heights and slopes are added to. The slopes are null if they are not wanted.
struct HeightSums {
  float *height, *slope_x, *slope_y, *slope_z;
};

// Adds amplitude times each kernel to the sums at kLanes points, one kernel after another.
void add_to_group(std::span<const ImpulseLane> lanes, float amplitude, const float* x, const float* y,
                  const float* z, const HeightSums& sums);

// Adds amplitude times each kernel of whole chunks to the sums at one point. The bits are those of
// add_to_group().
void add_at_point(std::span<const ImpulseChunk> chunks, float amplitude, float x, float y, float z,
                  const HeightSums& sums);

}  // namespace astrolith
