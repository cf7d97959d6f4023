#include "cuda/candidates_on_gpu.h"

#include "cuda/candidate_evaluator.h"
#include "cuda/device_backend.h"

namespace astrolith {

std::unique_ptr<CandidateEvaluator> candidates_on_gpu() {
  return std::make_unique<CandidateEvaluatorOn<DeviceBackend>>(DeviceBackend());
}

}  // namespace astrolith
