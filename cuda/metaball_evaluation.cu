#include "cuda/device_buffer.h"
#include "cuda/metaball_evaluation.h"

namespace astrolith {
namespace {

constexpr unsigned kThreadsPerBlock = 256;

__global__ void metaballs_kernel(MetaballParameters<float> body, const MetaballSphere<float>* spheres,
                                 std::size_t num_spheres, std::size_t num_points, const float* x,
                                 const float* y, const float* z, float* distance) {
  const std::size_t i = std::size_t{blockIdx.x} * blockDim.x + threadIdx.x;
  if (i >= num_points) return;
  const Vec3f p{x[i], y[i], z[i]};
  MetaballSums<float> sums{};
  for (std::size_t j = 0; j < num_spheres; ++j) accumulate_metaball(body, spheres[j], p, sums);
  distance[i] = metaball_distance(body, sums).distance;
}

}  // namespace

void evaluate_metaballs_on_gpu(const PreparedMetaballs& metaballs, std::span<const float> x,
                               std::span<const float> y, std::span<const float> z,
                               std::span<float> distance) {
  if (distance.empty()) return;
  const DeviceBuffer<MetaballSphere<float>> spheres(
      std::span<const MetaballSphere<float>>(metaballs.spheres));
  const DeviceBuffer<float> px(x), py(y), pz(z);
  DeviceBuffer<float> result(distance.size());
  const auto blocks = static_cast<unsigned>((distance.size() + kThreadsPerBlock - 1) / kThreadsPerBlock);
  metaballs_kernel<<<blocks, kThreadsPerBlock>>>(metaballs.parameters, spheres.data(), spheres.size(),
                                                 distance.size(), px.data(), py.data(), pz.data(),
                                                 result.data());
  check_cuda(cudaGetLastError(), "launching the metaball kernel");
  result.download(distance);
}

}  // namespace astrolith
