// Impulses of surface noise sixteen by sixteen, and the loops that add their kernels to heights. A chunk is a
// vector of the widest machine in each of an impulse's members: one point sees sixteen impulses at once, and
// sixteen points take one impulse after another from it.
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

  // Member k of impulse i at k * kLanes + i, members in the order of GaborImpulse. Lanes without an impulse
  // hold one whose kernel is 0 wherever points may be.
  std::array<float, kMembers * kLanes> members;
  // Holds the support of every impulse.
  std::array<float, 3> low, high;
};

// The impulses in their order; `a` is their bandwidth, cycles per length unit.
std::vector<ImpulseChunk> make_chunks(std::span<const GaborImpulse> impulses, double a);

// Float points low .. high along each axis.
struct PointBox {
  std::array<float, 3> low, high;
};

inline bool overlap(const PointBox& box, const std::array<float, 3>& low, const std::array<float, 3>& high) {
  return box.low[0] <= high[0] && box.low[1] <= high[1] && box.low[2] <= high[2] && low[0] <= box.high[0] &&
         low[1] <= box.high[1] && low[2] <= box.high[2];
}

// One impulse of a chunk: its first member, the others follow kLanes apart.
using ImpulseLane = const float*;
ASTROLITH_KERNEL GaborImpulse impulse_at(ImpulseLane lane) {
  constexpr std::size_t k = kLanes;
  return {lane[0],      lane[k],      lane[2 * k],  lane[3 * k],  lane[4 * k],
          lane[5 * k],  lane[6 * k],  lane[7 * k],  lane[8 * k],  lane[9 * k],
          lane[10 * k], lane[11 * k], lane[12 * k], lane[13 * k], lane[14 * k]};
}

// Appends the impulses of some chunks whose kernels may reach the box, in their order; never leaves one out
// that does.
void append_reaching(std::span<const ImpulseChunk* const> chunks, const PointBox& box,
                     std::vector<ImpulseLane>& lanes);

// Where heights are summed, and their slopes where these are wanted: null where not.
struct HeightSums {
  float *height, *slope_x, *slope_y, *slope_z;
};

// Adds amplitude times each kernel, one after another, to the sums at kLanes points.
void add_to_group(std::span<const ImpulseLane> lanes, float amplitude, const float* x, const float* y,
                  const float* z, const HeightSums& sums);

// Adds those of whole chunks to the sums at one point: the same bits.
void add_at_point(std::span<const ImpulseChunk* const> chunks, float amplitude, float x, float y, float z,
                  const HeightSums& sums);

}  // namespace astrolith
