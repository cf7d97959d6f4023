#include "synthesis/gabor/gabor_chunk.h"

#include <algorithm>
#include <cmath>
#include <cstring>
#include <limits>

namespace astrolith {
namespace {

// An impulse so far away that its kernel is 0 at every point of any body.
GaborImpulse nowhere() { return {1e18f, 0, 0, 1, 0, 0, 1, 0, 0, 1, 0, 0, 0, 0, 0}; }

// Half the extents along x, y and z of the support of a kernel. The support is a box along the frame of the
// impulse.
std::array<double, 3> half_extents(const GaborImpulse& k, double a) {
  const auto along = [a](float u, float v, float n) {
    const double tangential = std::fabs(double{u}) + std::fabs(double{v});
    return double{kGaborSlack} *
           (double{kGaborReach} * tangential + double{kGaborSlabReach} * std::fabs(double{n})) / (a * a);
  };
  return {along(k.ux, k.vx, k.nx), along(k.uy, k.vy, k.ny), along(k.uz, k.vz, k.nz)};
}

void extend(const GaborImpulse& impulse, double a, ImpulseChunk& chunk) {
  const std::array<double, 3> half = half_extents(impulse, a);
  const std::array<float, 3> center{impulse.x, impulse.y, impulse.z};
  for (std::size_t axis = 0; axis < 3; ++axis) {
    chunk.low[axis] = std::min(chunk.low[axis], static_cast<float>(double{center[axis]} - half[axis]));
    chunk.high[axis] = std::max(chunk.high[axis], static_cast<float>(double{center[axis]} + half[axis]));
  }
}

// Writes reaches[i] = 1 if the kernel of lane i may reach the box about `center`, else 0.
ASTROLITH_KERNEL void find_reaching(const ImpulseChunk& chunk, const float* center, const float* half,
                                    int* reaches) {
#pragma omp simd
  for (std::size_t i = 0; i < kLanes; ++i) {
    const GaborImpulse k = impulse_at(&chunk.members[i]);
    reaches[i] = beyond_gabor_reach(k, center, half) <= 0.0f ? 1 : 0;
  }
}

// Writes the lanes whose kernels may reach the box; at most kLanes lanes for each chunk. Returns their
// number.
ASTROLITH_SIMD_CLONES std::size_t write_reaching(const ImpulseChunk* const* chunks, std::size_t num_chunks,
                                                 const float* center, const float* half, ImpulseLane* lanes) {
  std::size_t count = 0;
  for (std::size_t c = 0; c < num_chunks; ++c) {
    std::array<int, kLanes> reaches;
    find_reaching(*chunks[c], center, half, reaches.data());
    for (std::size_t i = 0; i < kLanes; ++i) {
      lanes[count] = &chunks[c]->members[i];
      count += static_cast<std::size_t>(reaches[i]);
    }
  }
  return count;
}

ASTROLITH_SIMD_CLONES void add_values(const ImpulseLane* lanes, std::size_t num_lanes, float amplitude,
                                      const float* __restrict x, const float* __restrict y,
                                      const float* __restrict z, float* __restrict height) {
  for (std::size_t j = 0; j < num_lanes; ++j) {
    const GaborImpulse impulse = impulse_at(lanes[j]);
#pragma omp simd
    for (std::size_t i = 0; i < kLanes; ++i) {
      height[i] = math::fma(amplitude, gabor_kernel(impulse, x[i], y[i], z[i]), height[i]);
    }
  }
}

ASTROLITH_SIMD_CLONES void add_slopes(const ImpulseLane* lanes, std::size_t num_lanes, float amplitude,
                                      const float* __restrict x, const float* __restrict y,
                                      const float* __restrict z, float* __restrict height,
                                      float* __restrict sx, float* __restrict sy, float* __restrict sz) {
  for (std::size_t j = 0; j < num_lanes; ++j) {
    const GaborImpulse impulse = impulse_at(lanes[j]);
#pragma omp simd
    for (std::size_t i = 0; i < kLanes; ++i) {
      const GaborSample k = gabor_kernel_with_slope(impulse, x[i], y[i], z[i]);
      height[i] = math::fma(amplitude, k.value, height[i]);
      sx[i] = math::fma(amplitude, k.slope.x, sx[i]);
      sy[i] = math::fma(amplitude, k.slope.y, sy[i]);
      sz[i] = math::fma(amplitude, k.slope.z, sz[i]);
    }
  }
}

// The values of the kernels of a chunk at one point.
ASTROLITH_SIMD_CLONES void values_at_point(const ImpulseChunk& chunk, float x, float y, float z,
                                           float* __restrict value) {
#pragma omp simd
  for (std::size_t i = 0; i < kLanes; ++i) {
    value[i] = gabor_kernel(impulse_at(&chunk.members[i]), x, y, z);
  }
}

ASTROLITH_SIMD_CLONES void slopes_at_point(const ImpulseChunk& chunk, float x, float y, float z,
                                           float* __restrict value, float* __restrict sx,
                                           float* __restrict sy, float* __restrict sz) {
#pragma omp simd
  for (std::size_t i = 0; i < kLanes; ++i) {
    const GaborSample k = gabor_kernel_with_slope(impulse_at(&chunk.members[i]), x, y, z);
    value[i] = k.value;
    sx[i] = k.slope.x;
    sy[i] = k.slope.y;
    sz[i] = k.slope.z;
  }
}

// Adds the kernels one after another, in the order of a loop over impulses. Zeros do not change the sum. They
// are removed first, since each addition waits for the one before.
ASTROLITH_SIMD_CLONES float sum_of(const float* kernel, float amplitude, float sum) {
  std::array<float, kLanes> nonzero;
  std::size_t count = 0;
  for (std::size_t i = 0; i < kLanes; ++i) {
    nonzero[count] = kernel[i];
    count += kernel[i] != 0.0f ? 1 : 0;
  }
  for (std::size_t i = 0; i < count; ++i) sum = math::fma(amplitude, nonzero[i], sum);
  return sum;
}

}  // namespace

void set_lane(const GaborImpulse& impulse, std::size_t lane, ImpulseChunk& chunk) {
  std::array<float, ImpulseChunk::kMembers> members;
  std::memcpy(members.data(), &impulse, sizeof members);
  for (std::size_t k = 0; k < members.size(); ++k) chunk.members[k * kLanes + lane] = members[k];
}

void empty_lanes(std::size_t first, ImpulseChunk& chunk) {
  for (std::size_t lane = first; lane < kLanes; ++lane) set_lane(nowhere(), lane, chunk);
}

std::vector<ImpulseChunk> make_chunks(std::span<const GaborImpulse> impulses, double a) {
  constexpr float kInfinity = std::numeric_limits<float>::infinity();
  std::vector<ImpulseChunk> chunks((impulses.size() + kLanes - 1) / kLanes);
  for (std::size_t c = 0; c < chunks.size(); ++c) {
    chunks[c].low = {kInfinity, kInfinity, kInfinity};
    chunks[c].high = {-kInfinity, -kInfinity, -kInfinity};
    for (std::size_t i = 0; i < kLanes; ++i) {
      const std::size_t j = c * kLanes + i;
      const GaborImpulse impulse = j < impulses.size() ? impulses[j] : nowhere();
      if (j < impulses.size()) extend(impulse, a, chunks[c]);
      set_lane(impulse, i, chunks[c]);
    }
  }
  return chunks;
}

void append_reaching(std::span<const ImpulseChunk* const> chunks, const PointBox& box,
                     std::vector<ImpulseLane>& lanes) {
  std::array<float, 3> center, half;
  for (std::size_t axis = 0; axis < 3; ++axis) {
    center[axis] = 0.5f * (box.low[axis] + box.high[axis]);
    half[axis] = std::max(box.high[axis] - center[axis], center[axis] - box.low[axis]);
  }
  const std::size_t before = lanes.size();
  lanes.resize(before + chunks.size() * kLanes + 1);  // the last element is written, not kept
  const std::size_t count =
      write_reaching(chunks.data(), chunks.size(), center.data(), half.data(), &lanes[before]);
  lanes.resize(before + count);
}

void add_to_group(std::span<const ImpulseLane> lanes, float amplitude, const float* x, const float* y,
                  const float* z, const HeightSums& sums) {
  if (sums.slope_x == nullptr) {
    add_values(lanes.data(), lanes.size(), amplitude, x, y, z, sums.height);
  } else {
    add_slopes(lanes.data(), lanes.size(), amplitude, x, y, z, sums.height, sums.slope_x, sums.slope_y,
               sums.slope_z);
  }
}

void add_at_point(std::span<const ImpulseChunk> chunks, float amplitude, float x, float y, float z,
                  const HeightSums& sums) {
  std::array<float, kLanes> value, sx, sy, sz;
  for (const ImpulseChunk& chunk : chunks) {
    if (sums.slope_x == nullptr) {
      values_at_point(chunk, x, y, z, value.data());
    } else {
      slopes_at_point(chunk, x, y, z, value.data(), sx.data(), sy.data(), sz.data());
      *sums.slope_x = sum_of(sx.data(), amplitude, *sums.slope_x);
      *sums.slope_y = sum_of(sy.data(), amplitude, *sums.slope_y);
      *sums.slope_z = sum_of(sz.data(), amplitude, *sums.slope_z);
    }
    *sums.height = sum_of(value.data(), amplitude, *sums.height);
  }
}

}  // namespace astrolith
