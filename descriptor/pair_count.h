// Counts all pairs of oriented points by their surflet code and by the local code of one of the two points.
#pragma once

#include <cstdint>
#include <functional>
#include <span>
#include <vector>

#include "numerics/progress.h"
#include "numerics/vec3.h"

namespace astrolith {

// (num_local * bins^4) the element [l * bins^4 + s] is the number of unordered pairs with surflet bin s whose
// origin has local code l. Points are in units of their largest distance, the middle of their box is 0, and
// normals have unit length. Local codes are in [0, num_local), and kMinBins <= bins <= kMaxBins. Where both
// points qualify as origin, their local codes decide. Takes time O(n^2), and memory O(n) and num_local *
// bins^4 for each thread. Throws WorkError when progress asks to stop.
std::vector<std::uint64_t> count_pairs(std::span<const Vec3d> points, std::span<const Vec3d> normals,
                                       std::span<const std::int32_t> local, int num_local, int bins,
                                       const Progress& progress);

// A function that gives the same counts as count_pairs, for instance on a GPU. An empty one stands for
// count_pairs.
using PairCounter = std::function<std::vector<std::uint64_t>(
    std::span<const Vec3d> points, std::span<const Vec3d> normals, std::span<const std::int32_t> local,
    int num_local, int bins, const Progress& progress)>;

}  // namespace astrolith
