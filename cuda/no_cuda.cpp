// The functions of this folder in a build without a CUDA compiler. probe_device() says that there is no GPU.
// Callers must ask it first, and all other functions throw.
#include "cuda/candidate_evaluator.h"
#include "cuda/candidates_on_gpu.h"
#include "cuda/device.h"
#include "cuda/pair_count.h"
#include "numerics/errors.h"

namespace astrolith {
namespace {

[[noreturn]] void refuse() { throw WorkError("GPU: this program was built without CUDA"); }

}  // namespace

const DeviceStatus& probe_device() {
  static const DeviceStatus status{false, "this program was built without CUDA", "", 0, 0};
  return status;
}

std::vector<std::uint64_t> count_pairs_on_gpu(std::span<const Vec3d>, std::span<const Vec3d>,
                                              std::span<const std::int32_t>, int, int, const Progress&) {
  refuse();
}

std::unique_ptr<CandidateEvaluator> candidates_on_gpu() { refuse(); }

}  // namespace astrolith
