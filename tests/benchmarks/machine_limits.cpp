// Measures what one thread of this machine can do at most. Prints JSON:
//   vector_operations   floating-point vector operations a second, of `lanes` floats each, by independent
//                       fused multiply-adds in registers
//   lanes               floats of a vector
//   read_bytes          bytes a second that a sum over more memory than the caches hold reads
//   write_bytes         bytes a second that such memory is filled with
#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <cstdio>
#include <vector>

#include "tests/benchmarks/processor_seconds.h"

namespace astrolith {
namespace {

// Enough independent chains to fill two units that take four or five cycles for each operation.
constexpr int kChains = 12;

template <int kLanes>
[[gnu::always_inline]] inline void multiply_add(std::int64_t steps, float* values) {
  float x[kChains * kLanes];
  for (int i = 0; i < kChains * kLanes; ++i) x[i] = values[i];
  for (std::int64_t step = 0; step < steps; ++step) {
#pragma GCC unroll 256
    for (int i = 0; i < kChains * kLanes; ++i) x[i] = __builtin_fmaf(x[i], 0.9999f, 1e-4f);
  }
  for (int i = 0; i < kChains * kLanes; ++i) values[i] = x[i];
}

#if defined(__x86_64__)
[[gnu::target("avx512f,prefer-vector-width=512")]] void multiply_add_16(std::int64_t steps, float* values) {
  multiply_add<16>(steps, values);
}
[[gnu::target("avx2,fma")]] void multiply_add_8(std::int64_t steps, float* values) {
  multiply_add<8>(steps, values);
}
int lanes() { return __builtin_cpu_supports("avx512f") ? 16 : __builtin_cpu_supports("avx2") ? 8 : 4; }
#else
int lanes() { return 4; }
#endif

void multiply_add_widest(std::int64_t steps, float* values) {
#if defined(__x86_64__)
  if (lanes() == 16) return multiply_add_16(steps, values);
  if (lanes() == 8) return multiply_add_8(steps, values);
#endif
  multiply_add<4>(steps, values);
}

double vector_operations() {
  constexpr std::int64_t kSteps = 4'000'000;
  float values[kChains * 16] = {};
  const double seconds = least_processor_seconds([&] { multiply_add_widest(kSteps, values); });
  volatile float sink = values[3];
  (void)sink;
  return double(kSteps) * kChains / seconds;
}

std::uint64_t sum(const std::uint64_t* values, std::size_t n) {
  std::uint64_t total = 0;
  for (std::size_t i = 0; i < n; ++i) total += values[i];
  return total;
}

}  // namespace
}  // namespace astrolith

int main() {
  using namespace astrolith;
  constexpr std::size_t kWords = std::size_t{1} << 26;  // 512 MiB
  std::vector<std::uint64_t> memory(kWords, 1);
  volatile std::uint64_t sink = 0;
  const double reading = least_processor_seconds([&] { sink = sum(memory.data(), kWords); });
  const double writing =
      least_processor_seconds([&] { std::fill(memory.begin(), memory.end(), std::uint64_t{sink}); });
  constexpr double kBytes = double(kWords) * sizeof(std::uint64_t);
  std::printf("{\"vector_operations\": %.4g, \"lanes\": %d, \"read_bytes\": %.4g, \"write_bytes\": %.4g}\n",
              vector_operations(), lanes(), kBytes / reading, kBytes / writing);
}
