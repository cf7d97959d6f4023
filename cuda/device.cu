#include <array>

#include "cuda/device.h"
#include "cuda/device_buffer.h"
#include "numerics/hash_random.h"
#include "numerics/scalar_math.h"

namespace astrolith {
namespace {

constexpr int kProbeSize = 1024;

// Touches everything the field functions are made of.
ASTROLITH_HD float probe_value(std::uint32_t i) {
  const float x = 20.0f * unit_float(hash_cell(hash_seed(7, 1), static_cast<std::int32_t>(i), 2, 3)) - 10.0f;
  return math::exp(x) + math::log(math::abs(x)) * math::sin_turns(x) / math::sqrt(math::fma(x, x, 1.0f));
}

__global__ void probe_kernel(float* out) {
  const std::uint32_t i = blockIdx.x * blockDim.x + threadIdx.x;
  if (i < kProbeSize) out[i] = probe_value(i);
}

bool device_agrees_with_host() {
  DeviceBuffer<float> buffer(kProbeSize);
  probe_kernel<<<kProbeSize / 128, 128>>>(buffer.data());
  check_cuda(cudaGetLastError(), "launching the probe");
  std::array<float, kProbeSize> values{};
  buffer.download(values);
  for (std::uint32_t i = 0; i < kProbeSize; ++i) {
    if (math::bits_of(values[i]) != math::bits_of(probe_value(i))) return false;
  }
  return true;
}

}  // namespace

DeviceStatus probe_device() {
  DeviceStatus status;
  int count = 0;
  if (cudaGetDeviceCount(&count) != cudaSuccess || count == 0) {
    status.reason = "no CUDA device";
    return status;
  }
  try {
    cudaDeviceProp properties{};
    check_cuda(cudaGetDeviceProperties(&properties, 0), "reading the device's properties");
    status.name = properties.name;
    status.compute_capability = 10 * properties.major + properties.minor;
    status.memory_bytes = properties.totalGlobalMem;
    status.usable = device_agrees_with_host();
    if (!status.usable)
      status.reason = "the device computes other bits than the CPU; was this built for another GPU?";
  } catch (const WorkError& e) {
    status.reason = e.what();
  }
  return status;
}

}  // namespace astrolith
