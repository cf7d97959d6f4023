// A recipe's field and mesh together on one thread: sparse blocks, as synth makes them, beside the field at
// all N^3 samples, which are written for isosurface_peers.py to mesh. Seconds of the processor, as JSON.
//
//   dense_field_benchmark RECIPE.json N FIELD.raw
#include <cstdio>
#include <cstdlib>
#include <exception>
#include <fstream>
#include <vector>

#include "numerics/parallel_for.h"
#include "recipe/recipe_json.h"
#include "synthesis/field/field_mesh.h"
#include "synthesis/field/implicit_field.h"
#include "tests/benchmarks/processor_seconds.h"

namespace astrolith {
namespace {

class Discard : public MeshSink {
 public:
  void add_vertices(std::span<const MeshVertex>) override {}
  void add_triangles(std::span<const Triangle>) override {}
};

// Samples in cubes, each with what reaches it alone: x fastest in `values`.
class DenseField {
 public:
  DenseField(const SampleGrid& grid, int n)
      : grid_(grid), n_(n), values_(static_cast<std::size_t>(n) * static_cast<std::size_t>(n * n)) {}

  void evaluate(const ImplicitField& field) {
    for (int z = 0; z < n_; z += kCube) {
      for (int y = 0; y < n_; y += kCube) {
        for (int x = 0; x < n_; x += kCube) evaluate_cube(field, x, y, z);
      }
    }
  }
  void write(const char* file) const {
    std::ofstream out(file, std::ios::binary);
    out.write(reinterpret_cast<const char*>(values_.data()),
              static_cast<std::streamsize>(values_.size() * sizeof(float)));
  }

 private:
  static constexpr int kCube = 8;

  void evaluate_cube(const ImplicitField& field, int x0, int y0, int z0) {
    const int x1 = std::min(x0 + kCube, n_), y1 = std::min(y0 + kCube, n_), z1 = std::min(z0 + kCube, n_);
    std::vector<float> x, y, z;
    for (int c = z0; c < z1; ++c) {
      for (int b = y0; b < y1; ++b) {
        for (int a = x0; a < x1; ++a) {
          x.push_back(grid_.x(a));
          y.push_back(grid_.y(b));
          z.push_back(grid_.z(c));
        }
      }
    }
    std::vector<float> value(x.size());
    field.gather(grid_.box({x0, y0, z0}, {x1, y1, z1}, 0.0)).evaluate(x, y, z, value);
    std::size_t next = 0;
    for (int c = z0; c < z1; ++c) {
      for (int b = y0; b < y1; ++b) {
        for (int a = x0; a < x1; ++a) {
          values_[(static_cast<std::size_t>(c) * static_cast<std::size_t>(n_) + static_cast<std::size_t>(b)) *
                      static_cast<std::size_t>(n_) +
                  static_cast<std::size_t>(a)] = value[next++];
        }
      }
    }
  }

  SampleGrid grid_;
  int n_;
  std::vector<float> values_;
};

void measure(const ImplicitField& field, int n, const char* file) {
  MeshStatistics statistics;
  Discard discard;
  const double sparse =
      processor_seconds([&] { statistics = mesh_field(field, field.bounds(), n - 1, discard); });
  DenseField samples(make_sample_grid(field.bounds(), n - 1), n);
  const double dense = processor_seconds([&] { samples.evaluate(field); });
  samples.write(file);
  std::printf(
      "{\"size\": %d, \"triangles\": %lld, \"seconds_sparse\": %.2f, \"seconds_dense_field\": %.2f}\n", n,
      static_cast<long long>(statistics.triangles), sparse, dense);
}

}  // namespace
}  // namespace astrolith

int main(int argc, char** argv) {
  using namespace astrolith;
  const int n = argc == 4 ? std::atoi(argv[2]) : 0;
  if (n < 16 || n > 1024)
    return std::fprintf(stderr, "usage: dense_field_benchmark RECIPE.json N FIELD.raw, N from 16 to 1024\n"),
           2;
  try {
    const ThreadLimit one_thread(1);
    measure(ImplicitField(read_recipe(argv[1])), n, argv[3]);
  } catch (const std::exception& e) {
    return std::fprintf(stderr, "dense_field_benchmark: %s\n", e.what()), 1;
  }
}
