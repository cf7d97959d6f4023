// Isosurface of a precomputed field of N^3 floats on one thread: a sphere of radius 0.35 N roughened by a
// gyroid. Bounds of the bricks are taken first, as a field's own bounds would be known; both times are
// reported. isosurface_peers.py runs other packages on the same numbers.
//
//   isosurface_benchmark N [field.raw]      writes the field, x fastest, as 32-bit floats, where a file is
//   given
#include <sys/resource.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <ctime>
#include <fstream>

#include "numerics/parallel_for.h"
#include "synthesis/manifold_check.h"
#include "synthesis/mesher.h"

namespace astrolith {
namespace {

constexpr int kBrick = kBlockCells;

struct Range {
  float low = INFINITY, high = -INFINITY;
  void add(float v) {
    low = std::min(low, v);
    high = std::max(high, v);
  }
};

// Samples at integer positions 0 .. n - 1; a brick's range covers the samples of its cells, both ends.
class Samples {
 public:
  explicit Samples(int n) : n_(n), values_(static_cast<std::size_t>(n) * n * n) {
    const float k = 2.0f * 3.14159265f * 14.0f / static_cast<float>(n);
    const float middle = 0.5f * static_cast<float>(n - 1);
    parallel_for(0, n, [&](std::int64_t z) {
      for (int y = 0; y < n; ++y) {
        for (int x = 0; x < n; ++x) {
          const float fx = static_cast<float>(x), fy = static_cast<float>(y), fz = static_cast<float>(z);
          const float gyroid = std::sin(k * fx) * std::cos(k * fy) + std::sin(k * fy) * std::cos(k * fz) +
                               std::sin(k * fz) * std::cos(k * fx);
          values_[index(x, y, static_cast<int>(z))] = 0.35f * static_cast<float>(n) -
                                                      std::hypot(fx - middle, fy - middle, fz - middle) +
                                                      0.03f * static_cast<float>(n) * gyroid;
        }
      }
    });
  }

  void find_ranges() {
    bricks_ = (n_ - 1 + kBrick - 1) / kBrick;
    ranges_.assign(static_cast<std::size_t>(bricks_) * bricks_ * bricks_, Range());
    parallel_for(0, bricks_, [&](std::int64_t bz) {
      for (int by = 0; by < bricks_; ++by) {
        for (int bx = 0; bx < bricks_; ++bx)
          range(bx, by, static_cast<int>(bz)) = range_of(bx, by, static_cast<int>(bz));
      }
    });
  }

  std::size_t index(int x, int y, int z) const { return (static_cast<std::size_t>(z) * n_ + y) * n_ + x; }
  float at(float x, float y, float z) const {
    return values_[index(static_cast<int>(x), static_cast<int>(y), static_cast<int>(z))];
  }
  Range range_in(const Box& box) const {
    Range all;
    const auto first = [](double v) { return std::max(0, static_cast<int>(std::ceil(v)) / kBrick); };
    const auto last = [&](double v) {
      return std::min(bricks_ - 1, (static_cast<int>(std::floor(v)) - 1) / kBrick);
    };
    for (int z = first(box.min.z); z <= last(box.max.z); ++z) {
      for (int y = first(box.min.y); y <= last(box.max.y); ++y) {
        for (int x = first(box.min.x); x <= last(box.max.x); ++x) {
          const Range& r = ranges_[(static_cast<std::size_t>(z) * bricks_ + y) * bricks_ + x];
          all.add(r.low);
          all.add(r.high);
        }
      }
    }
    return all;
  }
  const std::vector<float>& values() const { return values_; }
  int size() const { return n_; }

 private:
  Range& range(int x, int y, int z) {
    return ranges_[(static_cast<std::size_t>(z) * bricks_ + y) * bricks_ + x];
  }
  Range range_of(int bx, int by, int bz) const {
    Range r;
    for (int z = bz * kBrick; z <= std::min(n_ - 1, (bz + 1) * kBrick); ++z) {
      for (int y = by * kBrick; y <= std::min(n_ - 1, (by + 1) * kBrick); ++y) {
        const float* row = &values_[index(bx * kBrick, y, z)];
        const int count = std::min(n_ - bx * kBrick, kBrick + 1);
        float low = r.low, high = r.high;
#pragma omp simd reduction(min : low) reduction(max : high)
        for (int x = 0; x < count; ++x) {
          low = std::min(low, row[x]);
          high = std::max(high, row[x]);
        }
        r = {low, high};
      }
    }
    return r;
  }

  int n_, bricks_ = 0;
  std::vector<float> values_;
  std::vector<Range> ranges_;
};

struct SampledBlock {
  const Samples* samples;
  Range range;

  BlockContent content() const {
    return range.low > 0.0f    ? BlockContent::kInside
           : range.high > 0.0f ? BlockContent::kMixed
                               : BlockContent::kOutside;
  }
  SampledBlock restricted_to(const Box& child) const { return {samples, samples->range_in(child)}; }
  void evaluate(std::span<const float> x, std::span<const float> y, std::span<const float> z,
                std::span<float> value, float) const {
    for (std::size_t i = 0; i < value.size(); ++i) value[i] = samples->at(x[i], y[i], z[i]);
  }
};

struct SampledField {
  const Samples& samples;
  SampledBlock gather(const Box& box) const { return {&samples, samples.range_in(box)}; }
};

class Discard : public MeshSink {
 public:
  void add_vertices(std::span<const MeshVertex>) override {}
  void add_triangles(std::span<const Triangle>) override {}
};

// Of the processor, which other programs on the machine do not add to.
double seconds_of(const auto& work) {
  const std::clock_t start = std::clock();
  work();
  return static_cast<double>(std::clock() - start) / CLOCKS_PER_SEC;
}

void write_raw(const Samples& samples, const char* file) {
  std::ofstream out(file, std::ios::binary);
  out.write(reinterpret_cast<const char*>(samples.values().data()),
            static_cast<std::streamsize>(samples.values().size() * sizeof(float)));
}

void measure(Samples& samples) {
  const int n = samples.size();
  Box bounds;
  bounds.extend({1, 1, 1});
  bounds.extend({n - 2.0, n - 2.0, n - 2.0});
  double ranges = INFINITY, meshing = INFINITY;
  MeshStatistics statistics;
  for (int repeat = 0; repeat < 5; ++repeat) {
    ranges = std::min(ranges, seconds_of([&] { samples.find_ranges(); }));
    Discard discard;
    meshing = std::min(
        meshing, seconds_of([&] { statistics = mesh_field(SampledField{samples}, bounds, n - 1, discard); }));
  }
  ManifoldCheck check;
  mesh_field(SampledField{samples}, bounds, n - 1, check);
  const ManifoldReport report = check.finish();
  const double triangles = static_cast<double>(statistics.triangles);
  std::printf("{\"size\": %d, \"triangles\": %lld, \"vertices\": %lld, \"closed\": %s, \"manifold\": %s, ", n,
              static_cast<long long>(statistics.triangles), static_cast<long long>(statistics.vertices),
              report.closed() ? "true" : "false", report.manifold() ? "true" : "false");
  std::printf(
      "\"seconds_ranges\": %.3f, \"seconds_mesh\": %.3f, \"mtriangles_per_s\": %.2f, "
      "\"mtriangles_per_s_with_ranges\": %.2f}\n",
      ranges, meshing, 1e-6 * triangles / meshing, 1e-6 * triangles / (meshing + ranges));
}

}  // namespace
}  // namespace astrolith

int main(int argc, char** argv) {
  using namespace astrolith;
  const int n = argc > 1 ? std::atoi(argv[1]) : 512;
  if (n < 16 || n > 1024)
    return std::fprintf(stderr, "usage: isosurface_benchmark N [field.raw], N from 16 to 1024\n"), 2;
  Samples samples(n);
  if (argc > 2) write_raw(samples, argv[2]);
  const ThreadLimit one_thread(1);
  measure(samples);
}
