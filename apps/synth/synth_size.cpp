#include "apps/synth/synth_size.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "apps/memory_use.h"
#include "numerics/errors.h"
#include "synthesis/mesh/mesh_prediction.h"
#include "synthesis/mesh/sample_grid.h"

namespace astrolith {
namespace {

// Below this resolution a mesh is small and quick: predicting would cost more than it tells.
constexpr int kWorthPredicting = 256;

// Memory of the program, its libraries and its threads.
constexpr double kBytesAnyway = 50e6;

// Bytes that a format takes for each triangle and half a vertex: in the file, and in memory until it is
// written.
struct OutputCost {
  double file;
  double memory;
};

OutputCost output_cost(const std::filesystem::path& output, MeshUse use) {
  const std::string extension = output.extension().string();
  const double collected = 36.0 * 1.5;  // vertices and normals as doubles, triangles; grown by doubling
  // Verticals, heights and edges of an erosion are gone before a picture is drawn.
  const double rendered = std::max(use.preview ? 120.0 : 0.0, use.erosion ? 112.0 : 0.0);
  if (extension == ".ply") return {25.0, rendered > 0.0 ? collected + rendered : 0.0};
  if (extension == ".stl") return {50.0, collected + rendered};
  if (extension == ".glb") return {24.0, collected + 24.0 + rendered};
  return {75.0, collected + rendered};
}

// A count in three characters or so: "1.2 M", "340 k".
std::string rounded(double count) {
  return count >= 1e6 ? fmt::format("{:.1f} M", count / 1e6) : fmt::format("{:.0f} k", count / 1e3);
}

}  // namespace

void declare_size_options(Program& program, MeshSizeRequest& request) {
  Option resolution = program.app
                          .add_option("--resolution", request.resolution,
                                      "cells along the body's longest side, border included")
                          .check(in_range(kMinResolution, kMaxResolution));
  program.app
      .add_option("--triangles", request.triangles,
                  "choose the resolution that gives about this many triangles, such as 1e6")
      .check(in_range(100.0, 1e10))
      .excludes(resolution)
      .default_text("");
  program.app
      .add_option(
          "--max-memory", request.max_memory_gb,
          "refuse meshes that are predicted to need more gigabytes of memory; without it three quarters of "
          "the machine's")
      .check(above_zero())
      .default_text("");
  program.app.add_flag(
      "--predict", request.only_predict,
      "only say how many triangles, bytes and seconds the mesh would take; nothing is written but "
      "the summary");
}

int choose_resolution(Program& program, const MeshSizeRequest& request,
                      const std::function<MeshStatistics(int resolution)>& mesh_at,
                      const std::filesystem::path& output, MeshUse use, int tiles) {
  const bool by_triangles = request.triangles > 0.0;
  const bool small = request.max_memory_gb <= 0.0 && request.resolution < kWorthPredicting;
  if (!by_triangles && !request.only_predict && small) {
    return request.resolution;
  }
  const MeshGrowth growth(mesh_at);

  MeshPrediction mesh =
      growth.at(by_triangles ? growth.resolution_for(request.triangles) : request.resolution);
  if (by_triangles && mesh.triangles < 0.9 * request.triangles) {
    throw InputError(
        fmt::format("--triangles: the finest mesh there is, resolution {}, has about {}; ask for fewer",
                    mesh.resolution, rounded(mesh.triangles)));
  }
  // The slab with the most surface has seldom more than twice its share.
  const double share = std::min(1.0, 2.0 / tiles);
  if (tiles > 1) {
    mesh.triangles *= share;
    mesh.evaluations *= share;
  }
  const OutputCost cost = output_cost(output, use);
  const double memory = kBytesAnyway + mesh.working_bytes + cost.memory * mesh.triangles;
  program.summary["resolution"] = mesh.resolution;
  program.summary["predicted"] = {{"triangles", mesh.triangles},
                                  {"file_bytes", cost.file * mesh.triangles},
                                  {"peak_bytes", memory},
                                  {"seconds", growth.seconds(mesh)}};
  if (memory > memory_limit(request.max_memory_gb)) {
    throw InputError(fmt::format(
        "{}: the mesh of about {} triangles needs {:.2g} GB of memory, more than {:.2g} GB; "
        "lower the resolution, raise --max-memory{}",
        output.string(), rounded(mesh.triangles), memory / 1e9, memory_limit(request.max_memory_gb) / 1e9,
        cost.memory > 0.0 ? ", or write .ply without --preview, which is streamed" : ""));
  }
  program.say(
      fmt::format("resolution {}: about {} triangles, {:.0f} MB file, {:.0f} MB memory, up to {:.0f} s{}",
                  mesh.resolution, rounded(mesh.triangles), cost.file * mesh.triangles / 1e6, memory / 1e6,
                  std::ceil(growth.seconds(mesh)), use.gabor_noise ? " and its Gabor noise" : ""));
  return mesh.resolution;
}

}  // namespace astrolith
