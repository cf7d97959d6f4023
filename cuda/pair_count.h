// The pair count of shape histograms on a GPU, with the counts of count_pairs (descriptor/pair_count.h).
#pragma once

#include "descriptor/pair_count.h"

namespace astrolith {

// Takes the parameters of count_pairs. Throws WorkError, with CUDA's words, when the device fails or has too
// little memory, and when progress asks to stop. Call probe_device() (device.h) first.
std::vector<std::uint64_t> count_pairs_on_gpu(std::span<const Vec3d> points, std::span<const Vec3d> normals,
                                              std::span<const std::int32_t> local, int num_local, int bins,
                                              const Progress& progress);

}  // namespace astrolith
