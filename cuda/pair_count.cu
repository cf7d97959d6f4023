#include "cuda/pair_count.h"

#include "cuda/device_backend.h"
#include "cuda/pair_groups.h"

namespace astrolith {

std::vector<std::uint64_t> count_pairs_on_gpu(std::span<const Vec3d> points, std::span<const Vec3d> normals,
                                              std::span<const std::int32_t> local, int num_local, int bins,
                                              const Progress& progress) {
  DeviceBackend backend;
  return count_pairs_on(backend, points, normals, local, num_local, bins, progress);
}

}  // namespace astrolith
