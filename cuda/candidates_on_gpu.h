// The CandidateEvaluator (candidate_evaluator.h) on the GPU.
#pragma once

#include <memory>

namespace astrolith {

class CandidateEvaluator;

// The evaluator's functions throw WorkError, with CUDA's words, when the device fails or has too little
// memory. Call probe_device() (device.h) first.
std::unique_ptr<CandidateEvaluator> candidates_on_gpu();

}  // namespace astrolith
