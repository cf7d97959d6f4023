// Whether a GPU is there that gives the bits of the CPU.
#pragma once

#include <cstddef>
#include <string>

#include "numerics/errors.h"

namespace astrolith {

struct DeviceStatus {
  bool usable = false;
  std::string reason;  // why not, in a few words; empty when usable
  std::string name;
  int compute_capability = 0;  // 10 * major + minor
  std::size_t memory_bytes = 0;
};

// What CUDA says where the device fails or has too little memory. The CPU can do the work from its beginning.
class DeviceError : public WorkError {
 public:
  using WorkError::WorkError;
};

// Looks, once, at device 0 and runs a small kernel whose results are known bit by bit. Code built for the
// wrong architecture must fail here, and not give a mesh of zeros later. Throws nothing.
const DeviceStatus& probe_device();

}  // namespace astrolith
