// The swarm's machine (swarm.h) that is the GPU.
#pragma once

#include <memory>

namespace astrolith {

class SwarmMachine;

// Its functions throw WorkError, with CUDA's words, when the device fails or has too little memory; see
// probe_device().
std::unique_ptr<SwarmMachine> swarm_on_gpu();

}  // namespace astrolith
