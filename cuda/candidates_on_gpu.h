// The swarm's backend (candidate_evaluator.h) that is the GPU.
#pragma once

#include <memory>

namespace astrolith {

class CandidateEvaluator;

// Its functions throw WorkError, with CUDA's words, when the device fails or has too little memory; see
// probe_device().
std::unique_ptr<CandidateEvaluator> candidates_on_gpu();

}  // namespace astrolith
