// Measures the isosurface of a precomputed field of N^3 floats on one thread: a sphere of radius 0.35 N
// roughened by a gyroid. isosurface_peers.py runs other packages on the same numbers. Prints seconds of the
// processor as JSON.
//
//   isosurface_benchmark N [field.raw]      field.raw: where the field is written, x fastest, as 32-bit
//   floats
#include <algorithm>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <fstream>
#include <vector>

#include "numerics/parallel_for.h"
#include "synthesis/mesh/manifold_check.h"
#include "tests/benchmarks/processor_seconds.h"
#include "tests/benchmarks/volume/volume_mesher.h"

namespace astrolith {
namespace {

// The field at the integer positions 0 .. n - 1.
std::vector<float> samples_of(int n) {
  std::vector<float> values(static_cast<std::size_t>(n) * static_cast<std::size_t>(n * n));
  const float k = 2.0f * 3.14159265f * 14.0f / static_cast<float>(n);
  const float middle = 0.5f * static_cast<float>(n - 1);
  parallel_for(0, n, [&](std::int64_t z) {
    float* value = values.data() + z * n * n;
    for (int y = 0; y < n; ++y) {
      for (int x = 0; x < n; ++x) {
        const float fx = static_cast<float>(x), fy = static_cast<float>(y), fz = static_cast<float>(z);
        const float gyroid = std::sin(k * fx) * std::cos(k * fy) + std::sin(k * fy) * std::cos(k * fz) +
                             std::sin(k * fz) * std::cos(k * fx);
        *value++ = 0.35f * static_cast<float>(n) - std::hypot(fx - middle, fy - middle, fz - middle) +
                   0.03f * static_cast<float>(n) * gyroid;
      }
    }
  });
  return values;
}

void write_raw(const std::vector<float>& values, const char* file) {
  std::ofstream out(file, std::ios::binary);
  out.write(reinterpret_cast<const char*>(values.data()),
            static_cast<std::streamsize>(values.size() * sizeof(float)));
}

void measure(const std::vector<float>& values, int n) {
  const SampleGrid grid{{}, 1.0, {n - 1, n - 1, n - 1}};
  MeshDiscard discard;
  VolumeMeshSize size;
  const double seconds = least_processor_seconds([&] { size = mesh_volume(grid, values, discard); });
  ManifoldCheck check;
  mesh_volume(grid, values, check);
  const ManifoldReport report = check.finish();
  std::printf("{\"size\": %d, \"triangles\": %lld, \"vertices\": %lld, \"closed\": %s, \"manifold\": %s, ", n,
              static_cast<long long>(size.triangles), static_cast<long long>(size.vertices),
              report.closed() ? "true" : "false", report.manifold() ? "true" : "false");
  std::printf("\"seconds\": %.3f, \"mtriangles_per_s\": %.2f}\n", seconds,
              1e-6 * static_cast<double>(size.triangles) / seconds);
}

}  // namespace
}  // namespace astrolith

int main(int argc, char** argv) {
  using namespace astrolith;
  const int n = argc > 1 ? std::atoi(argv[1]) : 512;
  if (n < 16 || n > 1024)
    return std::fprintf(stderr, "usage: isosurface_benchmark N [field.raw], N from 16 to 1024\n"), 2;
  const std::vector<float> values = samples_of(n);
  if (argc > 2) write_raw(values, argv[2]);
  const ThreadLimit one_thread(1);
  measure(values, n);
}
