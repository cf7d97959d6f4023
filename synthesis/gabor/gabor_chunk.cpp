#include "synthesis/gabor/gabor_chunk.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstring>
#include <limits>

namespace astrolith {
namespace {

// An impulse so far away that its kernel is 0 at every point of any body.
GaborImpulse nowhere() { return {1e18f, 0, 0, 0, 0, 0, 0, 0, 0, 0}; }

using Extents = std::array<float, 3>;

// Half the extents along x, y and z of the support of a kernel: a disc across the normal, and a slab.
Extents half_extents(const GaborImpulse& k, double a) {
  const auto along = [a](float normal) {
    const double n = double{normal} / a;
    const double tangential = std::sqrt(std::max(1.0 - n * n, 0.0));
    return static_cast<float>(
        (1.0 + 1e-6) * double{kGaborSlack} *
        (double{kGaborDiscReach} * tangential + double{kGaborSlabReach} * std::fabs(n)) / a);
  };
  return {along(k.nx), along(k.ny), along(k.nz)};
}

void extend(const GaborImpulse& impulse, const Extents& half, ImpulseChunk& chunk) {
  const std::array<float, 3> center{impulse.x, impulse.y, impulse.z};
  for (std::size_t axis = 0; axis < 3; ++axis) {
    chunk.low[axis] = std::min(chunk.low[axis], center[axis] - half[axis]);
    chunk.high[axis] = std::max(chunk.high[axis], center[axis] + half[axis]);
  }
}

// The members of the impulse in a lane.
ASTROLITH_KERNEL GaborImpulse impulse_at(const float* lane) {
  constexpr std::size_t k = kLanes;
  return {lane[0],     lane[k],     lane[2 * k], lane[3 * k], lane[4 * k],
          lane[5 * k], lane[6 * k], lane[7 * k], lane[8 * k], lane[9 * k]};
}

// The most chunks whose impulses are sorted into groups at once.
constexpr std::size_t kPiece = 32;

// Impulses that reach a target, and the impulses among them that reach each group.
struct GroupLists {
  std::array<GaborImpulse, kPiece * kLanes> impulses;
  std::array<std::array<std::uint16_t, kPiece * kLanes>, kLanes> numbers;
  std::array<std::size_t, kLanes> counts;
};

// Writes the impulses of a chunk that reach the target to `impulses`. Returns their number.
ASTROLITH_KERNEL std::size_t write_reaching(const ImpulseChunk& chunk, const GaborTarget& target,
                                            GaborImpulse* impulses) {
  std::array<int, kLanes> reaches;
#pragma omp simd
  for (std::size_t i = 0; i < kLanes; ++i) {
    reaches[i] = gabor_reaches(impulse_at(&chunk.members[i]), target) ? 1 : 0;
  }
  std::size_t count = 0;
  for (std::size_t i = 0; i < kLanes; ++i) {
    if (reaches[i] != 0) impulses[count++] = impulse_at(&chunk.members[i]);
  }
  return count;
}

// The groups that an impulse reaches, one bit each.
ASTROLITH_KERNEL std::uint32_t groups_reached(const GaborImpulse& k, float a_squared, const GroupBoxes& g) {
  std::uint32_t reached = 0;
#pragma omp simd reduction(| : reached)
  for (std::size_t i = 0; i < kLanes; ++i) {
    const bool reaches =
        gabor_reaches(k, a_squared, g.x[i], g.y[i], g.z[i], g.half_x[i], g.half_y[i], g.half_z[i], g.disc[i]);
    reached |= reaches ? 1u << i : 0u;
  }
  return reached;
}

// Sorts the impulses of at most kPiece chunks into groups.
ASTROLITH_KERNEL void sort_into_groups(const ImpulseChunk* const* chunks, std::size_t num_chunks,
                                       const GaborTarget& target, const GroupBoxes& groups,
                                       GroupLists& lists) {
  std::size_t count = 0;
  for (std::size_t c = 0; c < num_chunks; ++c) {
    count += write_reaching(*chunks[c], target, &lists.impulses[count]);
  }
  lists.counts.fill(0);
  const std::uint32_t used = (1u << groups.count) - 1u;
  for (std::size_t j = 0; j < count; ++j) {
    std::uint32_t reached = groups_reached(lists.impulses[j], target.a_squared, groups) & used;
    for (; reached != 0; reached &= reached - 1) {
      const auto g = static_cast<std::size_t>(std::countr_zero(reached));
      lists.numbers[g][lists.counts[g]++] = static_cast<std::uint16_t>(j);
    }
  }
}

ASTROLITH_KERNEL void add_values(const GaborImpulse* impulses, const std::uint16_t* numbers,
                                 std::size_t count, float scale, float amplitude, const float* __restrict x,
                                 const float* __restrict y, const float* __restrict z,
                                 float* __restrict height) {
  for (std::size_t j = 0; j < count; ++j) {
    const GaborImpulse impulse = impulses[numbers[j]];
#pragma omp simd
    for (std::size_t i = 0; i < kLanes; ++i) {
      height[i] = math::fma(amplitude, gabor_kernel(impulse, scale, x[i], y[i], z[i]), height[i]);
    }
  }
}

ASTROLITH_KERNEL void add_slopes(const GaborImpulse* impulses, const std::uint16_t* numbers,
                                 std::size_t count, float scale, float amplitude, const float* __restrict x,
                                 const float* __restrict y, const float* __restrict z,
                                 float* __restrict height, float* __restrict sx, float* __restrict sy,
                                 float* __restrict sz) {
  for (std::size_t j = 0; j < count; ++j) {
    const GaborImpulse impulse = impulses[numbers[j]];
#pragma omp simd
    for (std::size_t i = 0; i < kLanes; ++i) {
      const GaborSample k = gabor_kernel_with_slope(impulse, scale, x[i], y[i], z[i]);
      height[i] = math::fma(amplitude, k.value, height[i]);
      sx[i] = math::fma(amplitude, k.slope.x, sx[i]);
      sy[i] = math::fma(amplitude, k.slope.y, sy[i]);
      sz[i] = math::fma(amplitude, k.slope.z, sz[i]);
    }
  }
}

ASTROLITH_SIMD_CLONES void add_piece(const ImpulseChunk* const* chunks, std::size_t num_chunks, float scale,
                                     float amplitude, const GaborTarget& target, const GroupBoxes& groups,
                                     const HeightSums& sums, GroupLists& lists) {
  sort_into_groups(chunks, num_chunks, target, groups, lists);
  for (std::size_t g = 0; g < groups.count; ++g) {
    const std::size_t i = g * kLanes, count = lists.counts[g];
    const GaborImpulse* impulses = lists.impulses.data();
    const std::uint16_t* numbers = lists.numbers[g].data();
    if (sums.slope_x == nullptr) {
      add_values(impulses, numbers, count, scale, amplitude, sums.x + i, sums.y + i, sums.z + i,
                 sums.height + i);
    } else {
      add_slopes(impulses, numbers, count, scale, amplitude, sums.x + i, sums.y + i, sums.z + i,
                 sums.height + i, sums.slope_x + i, sums.slope_y + i, sums.slope_z + i);
    }
  }
}

// The values of the kernels of a chunk at one point.
ASTROLITH_SIMD_CLONES void values_at_point(const ImpulseChunk& chunk, float scale, float x, float y, float z,
                                           float* __restrict value) {
#pragma omp simd
  for (std::size_t i = 0; i < kLanes; ++i) {
    value[i] = gabor_kernel(impulse_at(&chunk.members[i]), scale, x, y, z);
  }
}

ASTROLITH_SIMD_CLONES void slopes_at_point(const ImpulseChunk& chunk, float scale, float x, float y, float z,
                                           float* __restrict value, float* __restrict sx,
                                           float* __restrict sy, float* __restrict sz) {
#pragma omp simd
  for (std::size_t i = 0; i < kLanes; ++i) {
    const GaborSample k = gabor_kernel_with_slope(impulse_at(&chunk.members[i]), scale, x, y, z);
    value[i] = k.value;
    sx[i] = k.slope.x;
    sy[i] = k.slope.y;
    sz[i] = k.slope.z;
  }
}

// Adds the kernels one after another, in the order of a loop over impulses. Zeros do not change the sum. They
// are removed first, since each addition waits for the one before.
ASTROLITH_SIMD_CLONES float add_in_order(const float* kernel, float amplitude, float sum) {
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
  Extents half{};
  const GaborImpulse* before = nullptr;
  for (std::size_t j = 0; j < impulses.size(); ++j) {
    const GaborImpulse& k = impulses[j];
    // The impulses of a cell share their normal.
    if (before == nullptr || k.nx != before->nx || k.ny != before->ny || k.nz != before->nz) {
      half = half_extents(k, a);
    }
    before = &k;
    ImpulseChunk& chunk = chunks[j / kLanes];
    if (j % kLanes == 0) {
      chunk.low = {kInfinity, kInfinity, kInfinity};
      chunk.high = {-kInfinity, -kInfinity, -kInfinity};
    }
    extend(k, half, chunk);
    set_lane(k, j % kLanes, chunk);
  }
  if (impulses.size() % kLanes != 0) empty_lanes(impulses.size() % kLanes, chunks.back());
  return chunks;
}

GaborTarget make_target(const PointBox& box, float a) {
  std::array<float, 3> center, half;
  for (std::size_t axis = 0; axis < 3; ++axis) {
    center[axis] = 0.5f * (box.low[axis] + box.high[axis]);
    half[axis] = std::max(box.high[axis] - center[axis], center[axis] - box.low[axis]);
  }
  return gabor_target(a, center.data(), half.data());
}

void add_to_groups(std::span<const ImpulseChunk* const> chunks, float a, float amplitude,
                   const GaborTarget& target, const GroupBoxes& groups, const HeightSums& sums) {
  GroupLists lists;
  for (std::size_t c = 0; c < chunks.size(); c += kPiece) {
    add_piece(&chunks[c], std::min(kPiece, chunks.size() - c), gabor_disc_scale(a), amplitude, target, groups,
              sums, lists);
  }
}

void add_at_point(std::span<const ImpulseChunk> chunks, float a, float amplitude, const HeightSums& sums) {
  const float scale = gabor_disc_scale(a), x = *sums.x, y = *sums.y, z = *sums.z;
  std::array<float, kLanes> value, sx, sy, sz;
  for (const ImpulseChunk& chunk : chunks) {
    if (sums.slope_x == nullptr) {
      values_at_point(chunk, scale, x, y, z, value.data());
    } else {
      slopes_at_point(chunk, scale, x, y, z, value.data(), sx.data(), sy.data(), sz.data());
      *sums.slope_x = add_in_order(sx.data(), amplitude, *sums.slope_x);
      *sums.slope_y = add_in_order(sy.data(), amplitude, *sums.slope_y);
      *sums.slope_z = add_in_order(sz.data(), amplitude, *sums.slope_z);
    }
    *sums.height = add_in_order(value.data(), amplitude, *sums.height);
  }
}

}  // namespace astrolith
