#include <array>

#include "cuda/device.h"
#include "cuda/device_buffer.h"
#include "numerics/hash_random.h"
#include "numerics/portable_double.h"
#include "numerics/scalar_math.h"

namespace astrolith {
namespace {

constexpr int kProbeSize = 1024;

// A value at i that uses every elementary function of the field and of its bounds.
struct Probe {
  std::int64_t single, wide;  // of equal size, so that no byte between them is left unset
};
ASTROLITH_HD Probe probe_value(std::uint32_t i) {
  const float x = 20.0f * unit_float(hash_cell(hash_seed(7, 1), static_cast<std::int32_t>(i), 2, 3)) - 10.0f;
  const float point =
      math::exp(x) + math::log(math::abs(x)) * math::sin_turns(x) / math::sqrt(math::fma(x, x, 1.0f));
  const double y = static_cast<double>(x);
  const double bound = portable::exp(y) + portable::log(std::fabs(y)) / std::sqrt(std::fma(y, y, 1.0));
  return {math::to_bits(point), portable::to_bits(bound)};
}

__global__ void probe_kernel(Probe* out) {
  const std::uint32_t i = blockIdx.x * blockDim.x + threadIdx.x;
  if (i < kProbeSize) out[i] = probe_value(i);
}

bool device_agrees_with_host() {
  DeviceBuffer<Probe> buffer(kProbeSize, nullptr);
  probe_kernel<<<kProbeSize / 128, 128>>>(buffer.data());
  check_cuda(cudaGetLastError(), "launching the probe");
  std::array<Probe, kProbeSize> values{};
  buffer.download(values);
  for (std::uint32_t i = 0; i < kProbeSize; ++i) {
    const Probe known = probe_value(i);
    if (values[i].single != known.single || values[i].wide != known.wide) return false;
  }
  return true;
}

DeviceStatus look_at_device() {
  DeviceStatus status;
  int count = 0;
  const cudaError_t found = cudaGetDeviceCount(&count);
  if (found != cudaSuccess || count == 0) {
    status.reason = "no CUDA device";
    if (found == cudaErrorInsufficientDriver) {
      status.reason += " (its driver is missing, or older than this program)";
    } else if (found != cudaSuccess && found != cudaErrorNoDevice) {
      status.reason += std::string(" (") + cudaGetErrorString(found) + ")";
    }
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

}  // namespace

const DeviceStatus& probe_device() {
  static const DeviceStatus status = look_at_device();
  return status;
}

}  // namespace astrolith
