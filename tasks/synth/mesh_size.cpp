#include "tasks/synth/mesh_job_internal.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "numerics/errors.h"
#include "numerics/memory_use.h"
#include "numerics/parallel_for.h"
#include "numerics/processor_clock.h"
#include "synthesis/mesh/sample_grid.h"
#include "tasks/job/words.h"

namespace astrolith {
namespace {

// Below this resolution a mesh is small and quick: predicting would cost more than it tells.
constexpr int kWorthPredicting = 256;

}  // namespace

void declare_size_options(Job& job, MeshSizeRequest& request) {
  Option resolution = job.options
                          .add_option("--resolution", request.resolution,
                                      "cells along the body's longest side, border included")
                          .check(in_range(kMinResolution, kMaxResolution));
  job.options
      .add_option("--triangles", request.triangles,
                  "choose the resolution that gives this many triangles, to about a twentieth, such as 1e6")
      .check(in_range(100.0, 1e10))
      .excludes(resolution)
      .default_text("");
  job.options
      .add_option(
          "--max-memory", request.max_memory_gb,
          "stay below this many gigabytes of memory: a mesh that is predicted to need more is refused, one "
          "that turns out to need more is stopped; without it meshes predicted to need more than three "
          "quarters of the machine's memory are refused")
      .check(above_zero())
      .default_text("");
  job.options.add_flag(
      "--predict", request.only_predict,
      "only say how many triangles, bytes (of .ply.zst before it is compressed), how much "
      "memory and how many "
      "seconds the mesh would take, from a coarse mesh and some places of its surface; "
      "nothing is written but "
      "the summary. Seconds of the processor are those of all threads together; seconds on "
      "idle cores are what "
      "the clock shows while nothing else runs on them. Triangles are mostly within 30 %, memory "
      "within 50 %, seconds "
      "within a factor of two. With --members it is said of the meshes and recipes of the "
      "set, from up to eight "
      "of them");
}

int choose_resolution(Job& job, const MeshSizeRequest& request, const PlannedMesh& mesh) {
  const bool small = request.max_memory_gb <= 0.0 && request.resolution < kWorthPredicting;
  if (request.triangles <= 0.0 && !request.only_predict && small) return request.resolution;

  const MeshPrediction predicted =
      predict_mesh(mesh, request.resolution, request.triangles,
                   {thread_limit(), job.seconds(), processor_seconds(), !request.only_predict});
  const int resolution = predicted.resolution;
  job.summary["resolution"] = resolution;
  job.summary["predicted"] = {{"triangles", predicted.triangles},
                              {"file_bytes", predicted.file_bytes},
                              {"peak_bytes", predicted.peak_bytes},
                              {"seconds", predicted.seconds},
                              {"processor_seconds", predicted.processor_seconds},
                              {"own_seconds", predicted.own_seconds},
                              {"own_evaluations", predicted.own_evaluations}};
  require_memory(mesh, predicted, memory_limit(request.max_memory_gb));
  const std::string line = fmt::format("resolution {}: about {} triangles, {} file, {} memory, {}",
                                       resolution, rounded_count(predicted.triangles),
                                       byte_words(predicted.file_bytes), byte_words(predicted.peak_bytes),
                                       seconds_words(predicted.seconds, predicted.processor_seconds));
  if (!request.only_predict) job.say(line);
  if (request.only_predict && !job.quiet) job.print_result(line + "\n");
  return resolution;
}

void fail_memory(const Job& job, const MeshSizeRequest& request, const std::filesystem::path& output) {
  const double limit = memory_limit(request.max_memory_gb) / 1e9;
  const double predicted = job.summary["predicted"]["peak_bytes"].get<double>() / 1e9;
  throw InputError(fmt::format(
      "{}: the mesh needs more than the {:.3g} GB of --max-memory, and more than the {:.3g} GB that "
      "were predicted; lower the resolution, or raise --max-memory to {:.3g}",
      output.string(), limit, predicted, 1.5 * std::max(limit, predicted)));
}

}  // namespace astrolith
