// Memory on the device, and the one place where CUDA calls are checked. For .cu files only.
#pragma once

#include <cuda_runtime.h>

#include <cstddef>
#include <cstdint>
#include <limits>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include "cuda/backend.h"

namespace astrolith {

// Throws DeviceError with CUDA's own words where `status` is an error. For an error of memory it throws
// OutOfDeviceMemory, after which the device can still be used.
inline void check_cuda(cudaError_t status, const char* what) {
  if (status == cudaSuccess) return;
  const std::string words = std::string("GPU: ") + what + ": " + cudaGetErrorString(status);
  if (status != cudaErrorMemoryAllocation) throw DeviceError(words);
  cudaGetLastError();  // the error is no longer pending
  throw OutOfDeviceMemory(words);
}

// Whether device 0 keeps freed memory in a pool for what is allocated next, which spares the driver's work.
inline bool has_memory_pool() {
  static const bool has = [] {
    int supported = 0;
    cudaMemPool_t pool = nullptr;
    std::uint64_t most = std::numeric_limits<std::uint64_t>::max();
    const bool kept = cudaDeviceGetAttribute(&supported, cudaDevAttrMemoryPoolsSupported, 0) == cudaSuccess &&
                      supported != 0 && cudaDeviceGetDefaultMemPool(&pool, 0) == cudaSuccess &&
                      cudaMemPoolSetAttribute(pool, cudaMemPoolAttrReleaseThreshold, &most) == cudaSuccess;
    cudaGetLastError();  // an error here only means that there is no pool
    return kept;
  }();
  return has;
}

// An array of plain structs on the device; freed with the object.
template <typename T>
class DeviceBuffer {
 public:
  DeviceBuffer() = default;
  // All work on the buffer belongs to the stream, which must outlive it.
  DeviceBuffer(std::size_t count, cudaStream_t stream) : count_(count), stream_(stream) {
    if (count == 0) return;
    void* data = nullptr;
    check_cuda(has_memory_pool() ? cudaMallocAsync(&data, count * sizeof(T), stream)
                                 : cudaMalloc(&data, count * sizeof(T)),
               "allocating memory");
    data_ = static_cast<T*>(data);
  }
  // Waits until the host's memory is no longer needed.
  DeviceBuffer(std::span<const T> host, cudaStream_t stream) : DeviceBuffer(host.size(), stream) {
    if (count_ == 0) return;
    check_cuda(cudaMemcpyAsync(data_, host.data(), host.size_bytes(), cudaMemcpyHostToDevice, stream),
               "copying to the device");
    check_cuda(cudaStreamSynchronize(stream), "waiting for the device");
  }
  DeviceBuffer(DeviceBuffer&& other) noexcept { *this = std::move(other); }
  DeviceBuffer(const DeviceBuffer&) = delete;
  DeviceBuffer& operator=(const DeviceBuffer&) = delete;
  DeviceBuffer& operator=(DeviceBuffer&& other) noexcept {
    std::swap(data_, other.data_);
    std::swap(count_, other.count_);
    std::swap(stream_, other.stream_);
    return *this;
  }
  ~DeviceBuffer() {
    if (data_ != nullptr && has_memory_pool()) {
      cudaFreeAsync(data_, stream_);
    } else {
      cudaFree(data_);
    }
  }

  // Copies elements from `first` on to the host, as many as it holds, after all work of the stream.
  void download(std::span<T> host, std::size_t first = 0) const {
    if (host.empty()) return;
    check_cuda(
        cudaMemcpyAsync(host.data(), data_ + first, host.size_bytes(), cudaMemcpyDeviceToHost, stream_),
        "copying from the device");
    check_cuda(cudaStreamSynchronize(stream_), "waiting for the device");
  }
  T* data() { return data_; }
  const T* data() const { return data_; }
  std::size_t size() const { return count_; }

 private:
  T* data_ = nullptr;
  std::size_t count_ = 0;
  cudaStream_t stream_ = nullptr;
};

// An array of plain structs on the host that the device copies into at the full rate of the bus. It keeps its
// memory when it shrinks; its content is arbitrary after it has grown.
template <typename T>
class PinnedBuffer {
 public:
  PinnedBuffer() = default;
  PinnedBuffer(PinnedBuffer&& other) noexcept
      : data_(std::exchange(other.data_, nullptr)), most_(std::exchange(other.most_, 0)) {}
  PinnedBuffer& operator=(PinnedBuffer&& other) noexcept {
    std::swap(data_, other.data_);
    std::swap(most_, other.most_);
    return *this;
  }
  ~PinnedBuffer() { cudaFreeHost(data_); }

  void resize(std::size_t count) {
    if (count <= most_) return;
    cudaFreeHost(std::exchange(data_, nullptr));
    most_ = 0;
    void* data = nullptr;
    const std::size_t most = count + count / 4;
    check_cuda(cudaMallocHost(&data, most * sizeof(T)), "allocating memory of the host");
    data_ = static_cast<T*>(data);
    most_ = most;
  }
  T* data() { return data_; }
  const T* data() const { return data_; }

 private:
  T* data_ = nullptr;
  std::size_t most_ = 0;  // elements that the memory holds
};

}  // namespace astrolith
