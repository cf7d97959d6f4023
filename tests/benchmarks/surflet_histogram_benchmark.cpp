// Measures the pairs a second of one core, and how many codes the core could make if none had to be counted:
//   surflet_histogram_benchmark --benchmark_repetitions=5
#include "descriptor/surflet_histogram.h"

#include <benchmark/benchmark.h>

#include "descriptor/surflet_pair.h"
#include "geometry/surface/mesh_sampling.h"
#include "numerics/hash_random.h"
#include "numerics/host_device.h"
#include "numerics/parallel_for.h"
#include "tests/support/meshes.h"

namespace {

using namespace astrolith;

// A torus has pairs in 231 of the 625 bins; random curvatures put its points into ten of the 25 local bins.
struct Input {
  SurfaceSamples samples;
  std::vector<double> curvatures;

  explicit Input(std::int64_t n) : samples(sample_surface(testing::torus(1, 0.4), n, 1)) {
    CounterRandom random(2);
    for (std::int64_t i = 0; i < n; ++i) curvatures.push_back(random.normal());
  }
};

void count_pairs_of(benchmark::State& state) {
  const auto n = static_cast<double>(state.range(0));
  state.counters["pairs"] = benchmark::Counter(
      0.5 * n * (n - 1), benchmark::Counter::kIsIterationInvariantRate, benchmark::Counter::kIs1000);
}

// Arguments: points, bins along each axis.
void wahl(benchmark::State& state) {
  const ThreadLimit one_core(1);
  const Input input(state.range(0));
  const auto bins = static_cast<int>(state.range(1));
  for (auto _ : state) {
    benchmark::DoNotOptimize(surflet_histogram(input.samples.points, input.samples.normals, bins));
  }
  count_pairs_of(state);
}
BENCHMARK(wahl)
    ->ArgsProduct({{2000, 10000, 20000, 100000}, {5}})
    ->ArgsProduct({{10000}, {2, 3, 4, 6, 7, 8, 9, 10}})
    ->Unit(benchmark::kMillisecond);

void ahd(benchmark::State& state) {
  const ThreadLimit one_core(1);
  const Input input(state.range(0));
  const auto bins = static_cast<int>(state.range(1));
  for (auto _ : state) {
    benchmark::DoNotOptimize(
        ahd_histogram(input.samples.points, input.samples.normals, input.curvatures, bins));
  }
  count_pairs_of(state);
}
BENCHMARK(ahd)
    ->ArgsProduct({{2000, 10000, 20000, 100000}, {5}})
    ->ArgsProduct({{10000}, {3, 4, 6, 8, 10}})
    ->Unit(benchmark::kMillisecond);

// The codes of one surflet with all others, summed instead of counted.
ASTROLITH_SIMD_CLONES std::int32_t sum_of_codes(const float* x, const float* y, const float* z,
                                                const float* nx, const float* ny, const float* nz,
                                                const float* mx, const float* my, const float* mz,
                                                std::int64_t i, std::int64_t n) {
  const Surflet one{{x[i], y[i], z[i]}, {nx[i], ny[i], nz[i]}, {mx[i], my[i], mz[i]}};
  std::int32_t sum = 0;
#pragma omp simd reduction(+ : sum)
  for (std::int64_t k = 0; k < n; ++k) {
    sum += surflet_code<5>(one, {{x[k], y[k], z[k]}, {nx[k], ny[k], nz[k]}, {mx[k], my[k], mz[k]}}) & 1023;
  }
  return sum;
}

void codes_without_counting(benchmark::State& state) {
  const Input input(state.range(0));
  std::vector<float> c[9];
  for (std::size_t k = 0; k < input.samples.points.size(); ++k) {
    const Vec3d p = 0.35 * input.samples.points[k], n = input.samples.normals[k], m = cross(n, p);
    const double values[] = {p.x, p.y, p.z, n.x, n.y, n.z, m.x, m.y, m.z};
    for (int d = 0; d < 9; ++d) c[d].push_back(static_cast<float>(values[d]));
  }
  std::int32_t sum = 0;
  for (auto _ : state) {
    for (std::int64_t i = 0; i < state.range(0); ++i) {
      sum += sum_of_codes(c[0].data(), c[1].data(), c[2].data(), c[3].data(), c[4].data(), c[5].data(),
                          c[6].data(), c[7].data(), c[8].data(), i, i) &
             1023;
    }
    benchmark::DoNotOptimize(sum);
  }
  count_pairs_of(state);
}
BENCHMARK(codes_without_counting)->Arg(10000)->Arg(100000)->Unit(benchmark::kMillisecond);

// The time of a whole histogram on all cores.
void all_cores(benchmark::State& state) {
  const Input input(state.range(0));
  for (auto _ : state) {
    benchmark::DoNotOptimize(ahd_histogram(input.samples.points, input.samples.normals, input.curvatures, 5));
  }
  count_pairs_of(state);
}
BENCHMARK(all_cores)->Arg(20000)->UseRealTime()->Unit(benchmark::kMillisecond);

}  // namespace
