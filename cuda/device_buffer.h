// Memory on the device, and the one place where CUDA calls are checked. For .cu files only.
#pragma once

#include <cuda_runtime.h>

#include <cstddef>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include "cuda/backend.h"

namespace astrolith {

// Throws WorkError with CUDA's own words where `status` is an error. For an error of memory it throws
// OutOfDeviceMemory, after which the device can still be used.
inline void check_cuda(cudaError_t status, const char* what) {
  if (status == cudaSuccess) return;
  const std::string words = std::string("GPU: ") + what + ": " + cudaGetErrorString(status);
  if (status != cudaErrorMemoryAllocation) throw WorkError(words);
  cudaGetLastError();  // the error is no longer pending
  throw OutOfDeviceMemory(words);
}

// An array of plain structs on the device; freed with the object.
template <typename T>
class DeviceBuffer {
 public:
  DeviceBuffer() = default;
  explicit DeviceBuffer(std::size_t count) : count_(count) {
    if (count != 0) check_cuda(cudaMalloc(&data_, count * sizeof(T)), "allocating memory");
  }
  explicit DeviceBuffer(std::span<const T> host) : DeviceBuffer(host.size()) {
    if (count_ != 0) {
      check_cuda(cudaMemcpy(data_, host.data(), host.size_bytes(), cudaMemcpyHostToDevice),
                 "copying to the device");
    }
  }
  DeviceBuffer(DeviceBuffer&& other) noexcept
      : data_(std::exchange(other.data_, nullptr)), count_(std::exchange(other.count_, 0)) {}
  DeviceBuffer(const DeviceBuffer&) = delete;
  DeviceBuffer& operator=(const DeviceBuffer&) = delete;
  DeviceBuffer& operator=(DeviceBuffer&& other) noexcept {
    std::swap(data_, other.data_);
    std::swap(count_, other.count_);
    return *this;
  }
  ~DeviceBuffer() { cudaFree(data_); }

  // Copies the first host.size() elements to the host.
  void download(std::span<T> host) const {
    if (!host.empty()) {
      check_cuda(cudaMemcpy(host.data(), data_, host.size_bytes(), cudaMemcpyDeviceToHost),
                 "copying from the device");
    }
  }
  T* data() { return data_; }
  const T* data() const { return data_; }
  std::size_t size() const { return count_; }

 private:
  T* data_ = nullptr;
  std::size_t count_ = 0;
};

}  // namespace astrolith
