// The interface through which the algorithms of this folder use a GPU: arrays in its memory, launches of many
// threads in groups, and a running sum. An algorithm is a template over a Backend. DeviceBackend
// (device_backend.h) runs it on the GPU. HostBackend (tests/cuda/host_backend.h) runs it on the CPU, where
// ordinary tests compare its results with those of the CPU's own algorithm.
//
//   template <class Backend>
//   void double_all(Backend& backend, std::vector<float>& values) {
//     auto array = backend.upload(std::span<const float>(values));
//     backend.launch("doubling", values.size(), Doubling{array.data()});   // struct Doubling: body(i)
//     backend.download(array, std::span(values));
//   }
//
// backend.launch_groups(what, groups, threads, body) calls body(group) for groups of threads that share
// Body::kGroupBytes of memory, kSharedBytes at most. Within it, group.each_thread(step) calls step(thread)
// for every thread of the group. No thread goes on before all threads have finished the step. What a thread
// must remember from step to step has to stay in the shared memory.
#pragma once

#include <cstddef>
#include <cstdint>

#include "cuda/device.h"
#include "numerics/host_device.h"

namespace astrolith {

// The memory that the threads of a group can share on every GPU, bytes.
inline constexpr std::size_t kSharedBytes = 48 * 1024;

// An array does not fit into the memory of a backend. A smaller batch of work may fit.
class OutOfDeviceMemory : public DeviceError {
 public:
  using DeviceError::DeviceError;
};

// Adds to a number to which other threads add at the same time. Returns the number before the addition.
template <typename T>
ASTROLITH_HD T add_atomically(T* sum, T amount) {
#ifdef __CUDA_ARCH__
  if constexpr (sizeof(T) == 8) {
    return static_cast<T>(
        atomicAdd(reinterpret_cast<unsigned long long*>(sum), static_cast<unsigned long long>(amount)));
  } else {
    return atomicAdd(sum, amount);
  }
#else
  const T before = *sum;
  *sum += amount;
  return before;
#endif
}

}  // namespace astrolith
