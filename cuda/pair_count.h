// The pair count of shape histograms on a GPU: count_pairs of descriptor/pair_count.h, count for count.
#pragma once

#include "descriptor/pair_count.h"

namespace astrolith {

// Throws WorkError, with CUDA's words, when the device fails or has too little memory, and when progress asks
// to stop; see probe_device().
std::vector<std::uint64_t> count_pairs_on_gpu(std::span<const Vec3d> points, std::span<const Vec3d> normals,
                                              std::span<const std::int32_t> local, int num_local, int bins,
                                              const Progress& progress);

}  // namespace astrolith
