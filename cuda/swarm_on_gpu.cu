#include "cuda/swarm_on_gpu.h"

#include "cuda/device_machine.h"
#include "cuda/swarm.h"

namespace astrolith {

std::unique_ptr<SwarmMachine> swarm_on_gpu() {
  return std::make_unique<SwarmOn<DeviceMachine>>(DeviceMachine());
}

}  // namespace astrolith
