// Whether a GPU is there that gives the bits of the CPU.
#pragma once

#include <cstddef>
#include <string>

namespace astrolith {

struct DeviceStatus {
  bool usable = false;
  std::string reason;  // why not, in a few words; empty when usable
  std::string name;
  int compute_capability = 0;  // 10 * major + minor
  std::size_t memory_bytes = 0;
};

// Looks at device 0 and runs a small kernel whose results are known bit by bit. Code built for the wrong
// architecture must fail here, and not give a mesh of zeros later. Throws nothing.
DeviceStatus probe_device();

}  // namespace astrolith
