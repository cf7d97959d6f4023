// What a mesh costs: the mesher alone, on a GPU too where there is one, and what follows it, its check and
// its file. For these a mesh is recorded once, and replayed.
//   sinks_benchmark RECIPE RESOLUTION [FILE.ply]
// Prints million triangles a second and processor seconds of the check alone, the file alone, and both.
#include <chrono>
#include <cstdio>
#include <cstdlib>
#include <ctime>
#include <filesystem>
#include <string>

#include "cuda/device.h"
#include "cuda/mesher/gpu_mesher.h"
#include "geometry/io/ply_stream_writer.h"
#include "synthesis/field/field_mesh.h"
#include "synthesis/mesh/even_mesh.h"
#include "synthesis/mesh/manifold_check.h"
#include "tasks/job/load_recipe.h"

namespace {

using namespace astrolith;

template <typename Work>
void time(const char* what, double triangles, const Work& work) {
  const auto start = std::chrono::steady_clock::now();
  const std::clock_t processor = std::clock();
  work();
  const double seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
  std::printf("%-16s %6.1f M triangles/s %6.2f s %6.2f processor s\n", what, 1e-6 * triangles / seconds,
              seconds, static_cast<double>(std::clock() - processor) / CLOCKS_PER_SEC);
}

}  // namespace

int main(int argc, char** argv) {
  if (argc < 3) return std::puts("sinks_benchmark RECIPE RESOLUTION [FILE.ply]"), 2;
  const std::string file = argc > 3 ? argv[3] : "sinks_benchmark.ply";
  const Recipe recipe = load_recipe(argv[1]);
  const ImplicitField field(recipe);
  RecordedMesh mesh;
  mesh_field(field, field.bounds(), std::atoi(argv[2]), mesh);
  const auto triangles = static_cast<double>(mesh.triangles.size());
  std::printf("%.1f M triangles\n", 1e-6 * triangles);
  const auto check = [&] {
    ManifoldCheck sink;
    mesh.replay(sink);
    if (!sink.finish().closed()) std::puts("not closed");
  };
  const auto write = [&] {
    PlyStreamWriter sink(file, {.length_unit = recipe.length_unit, .frame = {}, .comment = {}});
    mesh.replay(sink);
    sink.finish();
  };
  for (int round = 0; round < 3; ++round) {
    MeshDiscard nowhere;
    time("mesher", triangles, [&] { mesh_field(field, field.bounds(), std::atoi(argv[2]), nowhere); });
    if (probe_device().usable) {
      time("mesher on GPU", triangles,
           [&] { mesh_field_on_gpu(field, field.bounds(), std::atoi(argv[2]), nowhere); });
    }
    time("check", triangles, check);
    time("file", triangles, write);
    time("both", triangles, [&] {
      ManifoldCheck manifold;
      PlyStreamWriter writer(file, {.length_unit = recipe.length_unit, .frame = {}, .comment = {}});
      SinkList sinks;
      sinks.add(manifold);
      sinks.add(writer);
      mesh.replay(sinks);
      manifold.finish();
      writer.finish();
    });
  }
  std::filesystem::remove(file);
}
