// The GPU as a Backend (backend.h). For .cu files only.
#pragma once

#include <cub/device/device_scan.cuh>
#include <limits>
#include <memory>

#include "cuda/backend.h"
#include "cuda/device_buffer.h"

namespace astrolith {

// A group on the device. Every thread of the group runs the whole body.
class DeviceGroup {
 public:
  __device__ DeviceGroup(std::size_t index, void* shared) : index_(index), shared_(shared) {}
  ASTROLITH_HD std::size_t index() const { return index_; }
  ASTROLITH_HD void* shared() const { return shared_; }
#ifdef __CUDA_ARCH__
  __device__ unsigned threads() const { return blockDim.x; }
  template <typename Step>
  __device__ void each_thread(const Step& step) const {
    step(threadIdx.x);
    __syncthreads();
  }
#else
  unsigned threads() const { return 0; }  // never called; nvcc's pass over the host code needs it
  template <typename Step>
  void each_thread(const Step&) const {}
#endif

 private:
  std::size_t index_;
  void* shared_;
};

template <typename Body>
__global__ void run_threads(std::size_t threads, Body body) {
  const std::size_t i = std::size_t{blockIdx.x} * blockDim.x + threadIdx.x;
  if (i < threads) body(i);
}

template <typename Body>
__global__ void run_groups(Body body) {
  static_assert(Body::kGroupBytes <= kSharedBytes);
  __shared__ std::uint64_t shared[(Body::kGroupBytes + 7) / sizeof(std::uint64_t)];
  body(DeviceGroup(blockIdx.x, shared));
}

// A line of work on the GPU that others run beside. It may be moved from one thread to another.
class DeviceBackend {
 public:
  DeviceBackend() {
    cudaStream_t stream = nullptr;
    check_cuda(cudaStreamCreateWithFlags(&stream, cudaStreamNonBlocking), "starting a line of work");
    stream_.reset(stream);
  }

  template <typename T>
  using Array = DeviceBuffer<T>;
  template <typename T>
  using HostArray = PinnedBuffer<T>;

  template <typename T>
  Array<T> allocate(std::size_t count) {
    return Array<T>(count, stream_.get());
  }
  template <typename T>
  Array<T> upload(std::span<const T> values) {
    return Array<T>(values, stream_.get());
  }
  template <typename T>
  void fill_zero(Array<T>& array) {
    if (array.size() == 0) return;
    check_cuda(cudaMemsetAsync(array.data(), 0, array.size() * sizeof(T), stream_.get()), "clearing memory");
  }
  template <typename T>
  void download(const Array<T>& array, std::span<T> values) {
    array.download(values);
  }
  template <typename T>
  T read(const Array<T>& array, std::size_t index) {
    T value;
    array.download({&value, 1}, index);
    return value;
  }

  template <typename Body>
  void launch(const char* what, std::size_t threads, const Body& body) {
    constexpr unsigned kThreads = 256;
    if (threads == 0) return;
    const auto groups = static_cast<unsigned>((threads + kThreads - 1) / kThreads);
    run_threads<<<groups, kThreads, 0, stream_.get()>>>(threads, body);
    check_cuda(cudaGetLastError(), what);
  }
  template <typename Body>
  void launch_groups(const char* what, std::size_t groups, unsigned threads, const Body& body) {
    if (groups == 0) return;
    run_groups<<<static_cast<unsigned>(groups), threads, 0, stream_.get()>>>(body);
    check_cuda(cudaGetLastError(), what);
  }
  // Waits for all launches to end.
  void wait() { check_cuda(cudaStreamSynchronize(stream_.get()), "waiting for the device"); }
  void running_sum(Array<std::uint32_t>& values) {
    if (values.size() > static_cast<std::size_t>(std::numeric_limits<int>::max())) {
      throw OutOfDeviceMemory("GPU: more than 2^31 counts");
    }
    std::size_t bytes = 0;
    const auto sum = [&](void* scratch) {
      check_cuda(cub::DeviceScan::ExclusiveSum(scratch, bytes, values.data(), values.data(),
                                               static_cast<int>(values.size()), stream_.get()),
                 "adding up counts");
    };
    sum(nullptr);
    Array<char> scratch(bytes, stream_.get());
    sum(scratch.data());
  }

 private:
  struct EndStream {
    void operator()(cudaStream_t stream) const { cudaStreamDestroy(stream); }
  };
  std::unique_ptr<CUstream_st, EndStream> stream_;
};

}  // namespace astrolith
