// Counts all pairs of oriented points by their surflet codes and by a code that each point has of its own.
#pragma once

#include <cstdint>
#include <functional>
#include <span>
#include <vector>

#include "numerics/progress.h"
#include "numerics/vec3.h"

namespace astrolith {

// (num_local * bins^4) local-major: how many unordered pairs have surflet bin s and the local code l of their
// origin at [l * bins^4 + s]. Points are in units of their largest distance, their box around 0; normals have
// unit length; local codes are in [0, num_local). Should both points qualify as origin, their
// local codes decide. kMinBins <= bins <= kMaxBins. Time O(n^2), memory O(n) and num_local * bins^4 a thread.
// Throws WorkError when progress asks to stop.
std::vector<std::uint64_t> count_pairs(std::span<const Vec3d> points, std::span<const Vec3d> normals,
                                       std::span<const std::int32_t> local, int num_local, int bins,
                                       const Progress& progress);

// Whoever can do the same, count for count; the one above where it is empty.
using PairCounter = std::function<std::vector<std::uint64_t>(
    std::span<const Vec3d> points, std::span<const Vec3d> normals, std::span<const std::int32_t> local,
    int num_local, int bins, const Progress& progress)>;

}  // namespace astrolith
