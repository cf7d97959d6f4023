// Pairs a second of one core: surflet_histogram_benchmark --benchmark_repetitions=5
#include "descriptor/surflet_histogram.h"

#include <benchmark/benchmark.h>

#include "geometry/mesh_sampling.h"
#include "numerics/parallel_for.h"
#include "tests/support/meshes.h"

namespace {

using namespace astrolith;

void surflet_pairs(benchmark::State& state) {
  const ThreadLimit one_core(1);
  const SurfaceSamples s = sample_surface(testing::torus(1, 0.4), state.range(0), 1);
  for (auto _ : state) benchmark::DoNotOptimize(surflet_histogram(s.points, s.normals));
  const double pairs = 0.5 * static_cast<double>(state.range(0)) * static_cast<double>(state.range(0) - 1);
  state.counters["pairs"] =
      benchmark::Counter(pairs, benchmark::Counter::kIsIterationInvariantRate, benchmark::Counter::kIs1000);
}
BENCHMARK(surflet_pairs)->Arg(2000)->Arg(10000)->Unit(benchmark::kMillisecond);

}  // namespace
