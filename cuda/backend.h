// How the algorithms of this folder see a GPU: arrays in its memory, launches of many threads in groups, and
// a running sum. An algorithm is a template over a Backend; DeviceBackend (device_backend.h) runs it on the
// GPU, HostBackend (host_backend.h), its twin, on the CPU, where ordinary tests compare its results with
// those of the CPU's own algorithm.
//
//   template <class Backend>
//   void double_all(Backend& backend, std::vector<float>& values) {
//     auto array = backend.upload(std::span<const float>(values));
//     backend.launch("doubling", values.size(), Doubling{array.data()});   // struct Doubling: body(i)
//     backend.download(array, std::span(values));
//   }
//
// backend.launch_groups(what, groups, threads, body) calls body(group) for groups of threads that share
// Body::kGroupBytes of memory, kSharedBytes at most. There group.each_thread(step) calls step(thread) for
// every thread, and no thread goes on before all have done: what a thread must remember from step to step
// stays in the shared memory.
#pragma once

#include <cstddef>
#include <cstdint>

#include "numerics/errors.h"
#include "numerics/host_device.h"

namespace astrolith {

// Shared by the threads of a group: what every GPU has without asking.
inline constexpr std::size_t kSharedBytes = 48 * 1024;

// The memory of a backend does not hold what was asked for; a smaller batch may fit.
class OutOfDeviceMemory : public WorkError {
 public:
  using WorkError::WorkError;
};

// Adds to a number that other threads add to at the same time; returns what it was.
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
