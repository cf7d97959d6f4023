// What a GPU reaches: a table of rates, and what share of the device's limit each is.
//
//   gpu_benchmark        on the first GPU; says so where there is none
//
// Limits are measured in the same run: fused multiply-adds a second of a kernel that does nothing else, and
// bytes a second of a copy within the device. A rate's share of the arithmetic limit needs the number of
// instructions of one item: scripts/gpu.sh counts them in the machine code and prints them beside.
#include <chrono>
#include <cstdio>
#include <string>

#include "cuda/device.h"
#include "cuda/device_machine.h"
#include "cuda/field_on_machine.h"
#include "cuda/mesh_field.h"
#include "cuda/pair_count.h"
#include "tests/synthesis/bodies.h"

namespace astrolith {
namespace {

constexpr std::size_t kPoints = std::size_t{1} << 26;

double seconds_of(const auto& work) {
  work();  // warm
  check_cuda(cudaDeviceSynchronize(), "waiting");
  const auto start = std::chrono::steady_clock::now();
  work();
  check_cuda(cudaDeviceSynchronize(), "waiting");
  return std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
}

void row(const std::string& what, double amount, const char* unit, double seconds) {
  std::printf("| %-44s | %12.4g | %-14s | %9.4f |\n", what.c_str(), amount, unit, seconds);
}

struct FmaChains {
  float* out;
  __device__ void operator()(std::size_t i) const {
    float a[8];
    for (int k = 0; k < 8; ++k) a[k] = static_cast<float>(i + static_cast<std::size_t>(k));
    for (int n = 0; n < 1024; ++n) {
      for (int k = 0; k < 8; ++k) a[k] = __fmaf_rn(a[k], 0.999f, 0.001f);
    }
    float sum = 0.0f;
    for (const float v : a) sum += v;
    if (sum == 12345.0f) out[0] = sum;
  }
};

void limits(DeviceMachine& machine) {
  auto out = machine.allocate<float>(1);
  const std::size_t threads = std::size_t{1} << 22;
  const double s = seconds_of([&] { machine.launch("fma", threads, FmaChains{out.data()}); });
  row("limit: fused multiply-adds", threads * 8.0 * 1024.0 / s / 1e9, "G fma/s", s);
  const std::size_t bytes = std::size_t{1} << 30;
  auto from = machine.allocate<char>(bytes), to = machine.allocate<char>(bytes);
  const double c = seconds_of(
      [&] { check_cuda(cudaMemcpy(to.data(), from.data(), bytes, cudaMemcpyDeviceToDevice), "copying"); });
  row("limit: memory, read and written", 2.0 * bytes / c / 1e9, "GB/s", c);
}

// One octave over a lattice of points.
template <auto noise>
struct EvaluateNoise {
  NoiseOctave octave;
  float* out;
  ASTROLITH_HD void operator()(std::size_t i) const {
    const float x = static_cast<float>(i & 1023) * 0.01f, y = static_cast<float>(i >> 10 & 1023) * 0.013f,
                z = static_cast<float>(i >> 20) * 0.017f;
    out[i] = with_octave<noise>(octave, x, y, z, 0.0f);
  }
};

template <auto noise>
void measure_noise(DeviceMachine& machine, const char* name) {
  auto out = machine.allocate<float>(kPoints);
  const EvaluateNoise<noise> body{{3.0f, 1.0f, 1.0f, 7u, {}}, out.data()};
  const double s = seconds_of([&] { machine.launch(name, kPoints, body); });
  row(name, static_cast<double>(kPoints) / s / 1e6, "M points/s", s);
}

// The whole field at points around the surface.
struct EvaluateField {
  FlatField field;
  FlatBlocks parts;
  Vec3f low, extent;
  float* out;
  ASTROLITH_HD void operator()(std::size_t i) const {
    const Vec3f p{low.x + extent.x * static_cast<float>(i & 255) / 256.0f,
                  low.y + extent.y * static_cast<float>(i >> 8 & 255) / 256.0f,
                  low.z + extent.z * static_cast<float>(i >> 16) / 256.0f};
    out[i] = flat_value(field, parts.block(0), p, std::numeric_limits<float>::infinity());
  }
};

void measure_field(DeviceMachine& machine, const ImplicitField& field) {
  const FlatFieldData data(field);
  const FieldOnMachine<DeviceMachine> on_device(machine, data);
  const Vec3d c = field.bounds().center();
  const Vec3d half = 0.02 * field.bounds().extent();
  FlatBlocksData blocks(data);
  blocks.add(field.gather({c - half, c + half}));
  const BlocksOnMachine<DeviceMachine> parts(machine, blocks);
  const std::size_t n = std::size_t{1} << 24;
  auto out = machine.allocate<float>(n);
  const auto single = [](const Vec3d& v) { return Vec3f{float(v.x), float(v.y), float(v.z)}; };
  const EvaluateField body{on_device.view(), parts.view(), single(c - half), single(2.0 * half), out.data()};
  const double s = seconds_of([&] { machine.launch("field", n, body); });
  row("field of a block, " + std::to_string(blocks.spheres.size()) + " metaballs", n / s / 1e6, "M points/s",
      s);
}

Recipe asteroid() {
  Recipe recipe = testing::potato_recipe(500, 3);
  SpotLayer craters;
  craters.amplitude = 0.01;
  craters.size = 0.03;
  craters.cell_size = 0.12;
  craters.kappa = -0.4;
  craters.layers = 3;
  recipe.layers = {testing::fractal_layer(0.02, 3.0, 5), craters};
  return recipe;
}

// Resolutions for about 1, 10 and 100 million triangles: their number goes as the square.
void measure_mesh(const ImplicitField& field) {
  MeshDiscard sink;
  const MeshStatistics small = mesh_field_on_gpu(field, field.bounds(), 200, sink);
  for (const double wanted : {1e6, 1e7, 1e8}) {
    const int resolution = static_cast<int>(200.0 * std::sqrt(wanted / static_cast<double>(small.triangles)));
    MeshStatistics made;
    const double s = seconds_of([&] { made = mesh_field_on_gpu(field, field.bounds(), resolution, sink); });
    row("mesh of " + std::to_string(made.triangles) + " triangles",
        static_cast<double>(made.triangles) / s / 1e6, "M triangles/s", s);
  }
}

void measure_pairs(int n) {
  CounterRandom random(1);
  std::vector<Vec3d> points, normals;
  std::vector<std::int32_t> local;
  for (int i = 0; i < n; ++i) {
    normals.push_back(normalized(Vec3d{random.normal(), random.normal(), random.normal()}));
    points.push_back(0.5 * normals.back());
    local.push_back(static_cast<std::int32_t>(random.below(25)));
  }
  const double s = seconds_of([&] { count_pairs_on_gpu(points, normals, local, 25, 5, {}); });
  row("pairs of " + std::to_string(n) + " points", 0.5 * n * (n - 1.0) / s / 1e9, "G pairs/s", s);
}

void measure_all() {
  DeviceMachine machine;
  limits(machine);
  measure_noise<simplex_noise>(machine, "simplex noise");
  measure_noise<perlin_noise>(machine, "Perlin noise");
  measure_noise<worley_f1>(machine, "Worley noise, nearest");
  measure_noise<worley_f2_minus_f1>(machine, "Worley noise, second less nearest");
  const ImplicitField field(asteroid());
  measure_field(machine, field);
  measure_mesh(field);
  measure_pairs(100000);
  measure_pairs(1000000);
}

}  // namespace
}  // namespace astrolith

int main() {
  const astrolith::DeviceStatus status = astrolith::probe_device();
  if (!status.usable) return std::printf("no GPU here: %s\n", status.reason.c_str()), 0;
  std::printf("%s, compute capability %d\n\n", status.name.c_str(), status.compute_capability);
  std::printf("| %-44s | %12s | %-14s | %9s |\n|---|---|---|---|\n", "what", "rate", "unit", "seconds");
  try {
    astrolith::measure_all();
  } catch (const std::exception& e) {
    return std::fprintf(stderr, "gpu_benchmark: %s\n", e.what()), 1;
  }
}
