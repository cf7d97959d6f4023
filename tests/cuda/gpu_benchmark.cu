// Measures a GPU: prints a table of rates, and the share of the device's limit that each rate reaches.
//
//   gpu_benchmark            on the first GPU; says so, and exits with 3, where there is none
//   gpu_benchmark --probe    only says which
//
// The limits are measured in the same run: the instructions per second of a kernel that only issues fused
// multiply-adds, the bytes per second of a copy within the device, and those of a copy to the host. The cost
// of an item in instructions or bytes stands in `cost` below.
#include <chrono>
#include <cstdio>
#include <string>

#include "cuda/candidate_evaluator.h"
#include "cuda/candidates_on_gpu.h"
#include "cuda/device.h"
#include "cuda/device_backend.h"
#include "cuda/field_on_backend.h"
#include "cuda/mesher/gpu_mesher.h"
#include "cuda/pair_count.h"
#include "cuda/pair_groups.h"
#include "synthesis/field/field_at_point.h"
#include "tests/synthesis/block_lists.h"
#include "tests/synthesis/bodies.h"

namespace astrolith {
namespace {

constexpr std::size_t kPoints = std::size_t{1} << 26;
constexpr int kOctaves = 5;  // octaves of the asteroid's noise

double seconds_of(const auto& work) {
  work();  // warm-up
  check_cuda(cudaDeviceSynchronize(), "waiting");
  const auto start = std::chrono::steady_clock::now();
  work();
  check_cuda(cudaDeviceSynchronize(), "waiting");
  return std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
}

// The cost of one item. Instructions are counted in the PTX of this file's kernels, which have no loops (nvcc
// -ptx -arch=compute_90, release 13.0), without moves and without twelve for the index and the store.
namespace cost {
constexpr double kSimplex = 254.0, kPerlin = 310.0, kWorleyF1 = 615.0, kWorleyF2MinusF1 = 669.0;
constexpr double kMetaball = 42.0, kPair = 111.0;
// The bytes of a triangle that are copied to the host: half a vertex of six floats, and three numbers.
constexpr double kTriangleBytes = 24.0;
}  // namespace cost

// The limits of the device, per second.
struct Limits {
  double instructions, memory_bytes, bytes_to_host;
};

// Prints a row of the table. `share` is the share of the limit that `limit` names.
void row(const std::string& what, double amount, const char* unit, double seconds, double share,
         const char* limit) {
  std::printf("| %-44s | %12.4g | %-14s | %9.4f | %5.1f %% of %s |\n", what.c_str(), amount, unit, seconds,
              100.0 * share, limit);
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

Limits measure_limits(DeviceBackend& backend) {
  Limits limits{};
  auto out = backend.allocate<float>(1);
  const std::size_t threads = std::size_t{1} << 22;
  const double s = seconds_of([&] { backend.launch("fma", threads, FmaChains{out.data()}); });
  limits.instructions = static_cast<double>(threads) * 8.0 * 1024.0 / s;
  row("limit: fused multiply-adds", limits.instructions / 1e9, "G fma/s", s, 1.0, "itself");
  const std::size_t bytes = std::size_t{1} << 30;
  auto from = backend.allocate<char>(bytes), to = backend.allocate<char>(bytes);
  const double c = seconds_of(
      [&] { check_cuda(cudaMemcpy(to.data(), from.data(), bytes, cudaMemcpyDeviceToDevice), "copying"); });
  limits.memory_bytes = 2.0 * static_cast<double>(bytes) / c;
  row("limit: memory, read and written", limits.memory_bytes / 1e9, "GB/s", c, 1.0, "itself");
  std::vector<char> host(bytes / 4);
  const double h = seconds_of([&] { backend.download(from, std::span(host)); });
  limits.bytes_to_host = static_cast<double>(host.size()) / h;
  row("limit: to the host", limits.bytes_to_host / 1e9, "GB/s", h, 1.0, "itself");
  return limits;
}

// Evaluates one octave of noise at the points of a lattice.
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
void measure_noise(DeviceBackend& backend, const char* name, const Limits& limits, double instructions) {
  auto out = backend.allocate<float>(kPoints);
  const EvaluateNoise<noise> body{{3.0f, 1.0f, 1.0f, 7u, {}}, out.data()};
  const double s = seconds_of([&] { backend.launch(name, kPoints, body); });
  const double rate = static_cast<double>(kPoints) / s;
  row(name, rate / 1e6, "M points/s", s, rate * instructions / limits.instructions, "arithmetic");
}

// Evaluates the whole field at points around the surface.
struct EvaluateField {
  FieldView field;
  BlockListArrays lists;
  Vec3f low, extent;
  float* out;
  ASTROLITH_HD void operator()(std::size_t i) const {
    const Vec3f p{low.x + extent.x * static_cast<float>(i & 255) / 256.0f,
                  low.y + extent.y * static_cast<float>(i >> 8 & 255) / 256.0f,
                  low.z + extent.z * static_cast<float>(i >> 16) / 256.0f};
    out[i] = field_at(field, lists.block(0), p, std::numeric_limits<float>::infinity());
  }
};

// Codes one pair of surflets per thread. It exists so that its instructions can be counted.
struct OnePair {
  const float* surflets;
  std::size_t count;
  std::int64_t* codes;
  ASTROLITH_HD void operator()(std::size_t i) const {
    const auto surflet = [&](std::size_t k) {
      const auto c = [&](std::size_t d) { return surflets[d * count + k]; };
      return Surflet{{c(0), c(1), c(2)}, {c(3), c(4), c(5)}, {c(6), c(7), c(8)}};
    };
    codes[i] = surflet_code<5>(surflet(i), surflet(i + 1));
  }
};
// Evaluates one metaball per thread. It exists so that its instructions can be counted.
struct OneMetaball {
  MetaballParameters<float> body;
  MetaballSphere<float> sphere;
  MetaballSums<float>* sums;
  ASTROLITH_HD void operator()(std::size_t i) const {
    const Vec3f p{static_cast<float>(i), 1.0f, 2.0f};
    accumulate_gaussian(body, sphere, p, sums[i]);
  }
};

// Runs OnePair and OneMetaball once, so that they are compiled.
void run_counted_kernels(DeviceBackend& backend) {
  auto surflets = backend.allocate<float>(9 * 65);
  backend.fill_zero(surflets);
  auto codes = backend.allocate<std::int64_t>(64);
  backend.launch("one pair", 64, OnePair{surflets.data(), 65, codes.data()});
  auto sums = backend.allocate<MetaballSums<float>>(64);
  backend.fill_zero(sums);
  backend.launch("one metaball", 64, OneMetaball{{}, {}, sums.data()});
  backend.wait();
}

// The lists of blocks in the memory of a backend.
template <class Backend>
class BlocksOnBackend {
 public:
  BlocksOnBackend(Backend& backend, const BlockListStore& store)
      : view_(store.view()),
        metaballs_(upload(backend, store.metaballs, view_.metaballs)),
        first_metaball_(upload(backend, store.first_metaball, view_.first_metaball)),
        spots_(upload(backend, store.spots, view_.spots)),
        first_spot_(upload(backend, store.first_spot, view_.first_spot)),
        gabor_(upload(backend, store.gabor, view_.gabor)),
        first_gabor_(upload(backend, store.first_gabor, view_.first_gabor)),
        landforms_(upload(backend, store.landforms, view_.landforms)),
        first_landform_(upload(backend, store.first_landform, view_.first_landform)) {}

  // The lists in the backend's memory. The view is valid while this object lives.
  BlockListArrays view() const { return view_; }

 private:
  template <typename T>
  using Array = typename Backend::template Array<T>;

  // Uploads the values and sets a pointer of the view to them.
  template <typename T>
  static Array<T> upload(Backend& backend, const std::vector<T>& values, const T*& pointer) {
    Array<T> array = backend.upload(std::span<const T>(values));
    pointer = array.data();
    return array;
  }

  BlockListArrays view_;
  Array<MetaballSphere<float>> metaballs_;
  Array<std::uint32_t> first_metaball_;
  Array<SpotImpulse> spots_;
  Array<std::uint32_t> first_spot_;
  Array<GaborImpulse> gabor_;
  Array<std::uint32_t> first_gabor_;
  Array<std::uint32_t> landforms_;
  Array<std::uint32_t> first_landform_;
};

void measure_field(DeviceBackend& backend, const ImplicitField& field, const Limits& limits) {
  const FieldOnBackend<DeviceBackend> on_device(backend, field.tables());
  const Vec3d c = field.bounds().center();
  const Vec3d half = 0.02 * field.bounds().extent();
  BlockListStore blocks(field.tables());
  blocks.add(field.tables(), {c - half, c + half});
  const BlocksOnBackend<DeviceBackend> lists(backend, blocks);
  const std::size_t n = std::size_t{1} << 24;
  auto out = backend.allocate<float>(n);
  const auto single = [](const Vec3d& v) { return Vec3f{float(v.x), float(v.y), float(v.z)}; };
  const EvaluateField body{on_device.view(), lists.view(), single(c - half), single(2.0 * half), out.data()};
  const double s = seconds_of([&] { backend.launch("field", n, body); });
  const auto metaballs = static_cast<double>(blocks.metaballs.size());
  const double rate = static_cast<double>(n) / s;
  row("body and layers, " + std::to_string(blocks.metaballs.size()) + " metaballs", rate / 1e6, "M points/s",
      s, rate * (metaballs * cost::kMetaball + kOctaves * cost::kSimplex) / limits.instructions,
      "arithmetic (without spots)");
}

Recipe asteroid() {
  Recipe recipe = testing::potato_recipe(500, 3);
  SpotLayer craters;
  craters.amplitude = 0.01;
  craters.size = 0.03;
  craters.cell_size = 0.12;
  craters.kappa = -0.4;
  craters.layers = 3;
  recipe.layers = {testing::fractal_layer(0.02, 3.0, kOctaves), craters};
  return recipe;
}

// Measures meshes of about 1, 10 and 100 million triangles. The number of triangles grows with the square of
// the resolution.
void measure_mesh(const ImplicitField& field, const Limits& limits) {
  MeshDiscard sink;
  const MeshStatistics small = mesh_field_on_gpu(field, field.bounds(), 200, sink);
  for (const double wanted : {1e6, 1e7, 1e8}) {
    const int resolution = static_cast<int>(200.0 * std::sqrt(wanted / static_cast<double>(small.triangles)));
    MeshStatistics made;
    const double s = seconds_of([&] { made = mesh_field_on_gpu(field, field.bounds(), resolution, sink); });
    const double rate = static_cast<double>(made.triangles) / s;
    row("mesh of " + std::to_string(made.triangles) + " triangles", rate / 1e6, "M triangles/s", s,
        rate * cost::kTriangleBytes / limits.bytes_to_host, "copying to the host");
  }
}

void measure_pairs(int n, const Limits& limits) {
  CounterRandom random(1);
  std::vector<Vec3d> points, normals;
  std::vector<std::int32_t> local;
  for (int i = 0; i < n; ++i) {
    normals.push_back(normalized(Vec3d{random.normal(), random.normal(), random.normal()}));
    points.push_back(0.5 * normals.back());
    local.push_back(static_cast<std::int32_t>(random.below(25)));
  }
  const double s = seconds_of([&] { count_pairs_on_gpu(points, normals, local, 25, 5, {}); });
  const double rate = 0.5 * n * (n - 1.0) / s;
  row("pairs of " + std::to_string(n) + " points", rate / 1e9, "G pairs/s", s,
      rate * cost::kPair / limits.instructions, "arithmetic");
}

// Measures the work of the search for details in 2,000 evaluations: 100 generations of 20 candidates. Each
// candidate has three noises of eight octaves, 25,000 lines and the pairs of 4,000 samples.
void measure_swarm(const Limits& limits) {
  constexpr std::size_t kCandidates = 20, kLines = 25000, kGenerations = 100;
  constexpr int kSamples = 4000;
  CounterRandom random(2);
  const PreparedMetaballs body = prepare_metaballs(*testing::potato_recipe(50, 4).body);
  ProbeLines lines;
  lines.metaballs = body.spheres;
  lines.first_metaball = {0, static_cast<std::uint32_t>(body.spheres.size())};
  lines.parameters = body.parameters;
  lines.reach = 0.05f;
  lines.steps = 3;
  for (std::size_t i = 0; i < kLines; ++i) {
    const Vec3d u = normalized(Vec3d{random.normal(), random.normal(), random.normal()});
    const Vec3f d{float(u.x), float(u.y), float(u.z)};
    lines.start.push_back(d * 0.5f);
    lines.direction.push_back(d);
    lines.block.push_back(0);
  }
  const Box domain{{-1, -1, -1}, {1, 1, 1}};
  const std::vector<FractalLayer> layers(3, testing::fractal_layer(0.01, 4.0, 8));
  Candidates candidates;
  for (std::size_t c = 0; c < kCandidates; ++c) candidates.add(layers, 1, domain);
  std::vector<SurfletArrays> sets;
  for (std::size_t c = 0; c < kCandidates; ++c) {
    std::vector<Vec3d> points, normals;
    for (int i = 0; i < kSamples; ++i) {
      normals.push_back(normalized(Vec3d{random.normal(), random.normal(), random.normal()}));
      points.push_back(0.5 * normals.back());
    }
    sets.emplace_back(points, normals, std::vector<std::int32_t>(kSamples, 0), 25);
  }
  const std::unique_ptr<CandidateEvaluator> swarm = candidates_on_gpu();
  const double s = seconds_of([&] {
    for (std::size_t g = 0; g < kGenerations; ++g) {
      swarm->heights(lines, candidates);
      swarm->count(sets, 5);
    }
  });
  const double evaluations = kCandidates * kGenerations, rate = evaluations / s;
  const double points = double{kLines} * (lines.steps * (24.0 * cost::kSimplex + 50.0 * cost::kMetaball));
  row("search for details, 2,000 evaluations", rate, "evaluations/s", s,
      rate * (points + 0.5 * kSamples * (kSamples - 1.0) * cost::kPair) / limits.instructions, "arithmetic");
}

void measure_all() {
  DeviceBackend backend;
  const Limits limits = measure_limits(backend);
  run_counted_kernels(backend);
  measure_noise<simplex_noise>(backend, "simplex noise", limits, cost::kSimplex);
  measure_noise<perlin_noise>(backend, "Perlin noise", limits, cost::kPerlin);
  measure_noise<worley_f1>(backend, "Worley noise, nearest", limits, cost::kWorleyF1);
  measure_noise<worley_f2_minus_f1>(backend, "Worley noise, second less nearest", limits,
                                    cost::kWorleyF2MinusF1);
  const ImplicitField field(asteroid());
  measure_field(backend, field, limits);
  measure_mesh(field, limits);
  measure_pairs(100000, limits);
  measure_pairs(1000000, limits);
  measure_swarm(limits);
}

}  // namespace
}  // namespace astrolith

int main(int argc, char** argv) {
  const astrolith::DeviceStatus status = astrolith::probe_device();
  if (!status.usable) return std::fprintf(stderr, "no GPU here: %s\n", status.reason.c_str()), 3;
  std::printf("%s, compute capability %d.%d\n\n", status.name.c_str(), status.compute_capability / 10,
              status.compute_capability % 10);
  if (argc > 1 && std::string(argv[1]) == "--probe") return 0;
  std::printf("| %-44s | %12s | %-14s | %9s | %s |\n|---|---|---|---|---|\n", "what", "rate", "unit",
              "seconds", "share of the limit");
  try {
    astrolith::measure_all();
  } catch (const std::exception& e) {
    return std::fprintf(stderr, "gpu_benchmark: %s\n", e.what()), 1;
  }
}
