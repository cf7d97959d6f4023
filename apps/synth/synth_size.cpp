#include "apps/synth/synth_size.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <ctime>
#include <thread>

#include "apps/counted.h"
#include "apps/memory_use.h"
#include "numerics/errors.h"
#include "synthesis/field/field_mesh.h"
#include "synthesis/field/field_tables.h"
#include "synthesis/mesh/processor_clock.h"
#include "tasks/synthesis/mesh_estimate.h"

namespace astrolith {
namespace {

// Below this resolution a mesh is small and quick: predicting would cost more than it tells.
constexpr int kWorthPredicting = 256;

struct Prediction {
  double triangles = 0.0, file_bytes = 0.0, peak_bytes = 0.0, seconds = 0.0;
  double own_seconds = 0.0;      // that the prediction itself took
  double own_evaluations = 0.0;  // of the field, by the estimate of its blocks and triangles
};

int threads_of(const Program& program) {
  return program.threads > 0 ? program.threads
                             : std::max(1, static_cast<int>(std::thread::hardware_concurrency()));
}

// Seconds of the work so far. Other programs on the machine slow its clock, and the threads of this one add
// up on the processor's, so that the lower one counts.
double seconds_so_far(const Program& program) {
  return std::min(program.seconds(), static_cast<double>(std::clock()) / CLOCKS_PER_SEC);
}

// What a prediction may take. With --predict the figures are all that is asked for. Otherwise they guard the
// memory of a mesh, which should hardly wait for them. The seconds that count even for the smallest mesh are
// about those in which the program starts.
constexpr EstimateBudget kForFigures{0.025, 0.004}, kForMemory{0.015, 0.01};

Prediction predict(const Program& program, int resolution, const PlannedMesh& mesh,
                   const EstimateBudget& budget) {
  const ProcessorClock clock;
  const double seconds_before = seconds_so_far(program), peak_before = static_cast<double>(peak_bytes());
  const MeshEstimate estimate = estimate_region(mesh.field, mesh.recipe, mesh.region, resolution, budget);
  const GaborCost gabor_tiles = gabor_cost(mesh.field, estimate);
  const OutputCost output = output_cost(mesh.output, mesh.use, estimate.triangles);
  const ErosionCost erosion =
      mesh.use.erosion ? erosion_cost(mesh.field, mesh.recipe, estimate) : ErosionCost{};
  // A peak that the sample made is one of blocks, which the mesh will have too.
  const double peak_after = static_cast<double>(peak_bytes());
  const double held = peak_after > peak_before ? peak_after : static_cast<double>(resident_bytes());
  const double labels = mesh.use.labels ? label_seconds(mesh.field, mesh.recipe, mesh.region, estimate) : 0.0;
  const double gravity = mesh.use.gravity ? gravity_seconds(mesh.field, mesh.recipe, estimate) : 0.0;
  const EvenCost even = mesh.use.even ? even_cost(estimate) : EvenCost{};
  const double working = std::max({meshing_bytes(estimate), erosion.bytes, even.table_bytes}) +
                         even.recorded_bytes +
                         more_cache_bytes(mesh.field.gabor_caches(), gabor_tiles.bytes, threads_of(program)) +
                         output.memory * estimate.triangles;
  const double times = mesh.use.twice ? 2.0 : 1.0;
  Prediction predicted;
  predicted.triangles = estimate.triangles;
  predicted.file_bytes = output.file * estimate.triangles;
  predicted.peak_bytes = std::max(peak_after, held + working);
  const double parallel = times * (estimate.seconds + fresh_memory_seconds(estimate) + gabor_tiles.seconds) +
                          erosion.parallel_seconds + labels + gravity + even.seconds;
  const double serial = times * output_seconds_per_triangle() * estimate.triangles + erosion.serial_seconds;
  predicted.seconds = seconds_before + parallel / threads_of(program) + serial;
  predicted.own_evaluations = estimate.spent_evaluations;
  predicted.own_seconds = clock.seconds();
  return predicted;
}

void check_memory(const MeshSizeRequest& request, int resolution, const PlannedMesh& mesh,
                  const Prediction& predicted) {
  const double limit = memory_limit(request.max_memory_gb);
  if (predicted.peak_bytes <= limit) return;
  const bool collected =
      mesh.use.even || output_cost(mesh.output, mesh.use, predicted.triangles).memory > 0.0;
  throw InputError(fmt::format(
      "{}: the mesh of about {} triangles at resolution {} needs {:.3g} GB of memory, more than {:.3g} GB; "
      "lower the resolution, raise --max-memory{}",
      mesh.output.string(), rounded_count(predicted.triangles), resolution, predicted.peak_bytes / 1e9,
      limit / 1e9, collected ? ", or write .ply without --preview and --even, which is streamed" : ""));
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
          "stay below this many gigabytes of memory: a mesh that is predicted to need more is refused, one "
          "that turns out to need more is stopped; without it meshes predicted to need more than three "
          "quarters of the machine's memory are refused")
      .check(above_zero())
      .default_text("");
  program.app.add_flag("--predict", request.only_predict,
                       "only say how many triangles, bytes (of .ply.zst before it is compressed) and seconds "
                       "the mesh would take; "
                       "nothing is written but the summary. Beside the start of the program this takes about "
                       "3 % of the predicted "
                       "seconds, or some 10 milliseconds if these are more. With --members it is said of all "
                       "files of the set: small "
                       "members are made for that, up to eight, in a temporary folder");
}

int choose_resolution(Program& program, const MeshSizeRequest& request, const PlannedMesh& mesh) {
  const bool by_triangles = request.triangles > 0.0;
  const bool small = request.max_memory_gb <= 0.0 && request.resolution < kWorthPredicting;
  if (!by_triangles && !request.only_predict && small) return request.resolution;

  const int resolution =
      by_triangles ? resolution_for_triangles(mesh.field, mesh.recipe, mesh.region, request.triangles)
                   : request.resolution;
  const Prediction predicted =
      predict(program, resolution, mesh, request.only_predict ? kForFigures : kForMemory);
  program.summary["resolution"] = resolution;
  program.summary["predicted"] = {
      {"triangles", predicted.triangles},     {"file_bytes", predicted.file_bytes},
      {"peak_bytes", predicted.peak_bytes},   {"seconds", predicted.seconds},
      {"own_seconds", predicted.own_seconds}, {"own_evaluations", predicted.own_evaluations}};
  check_memory(request, resolution, mesh, predicted);
  program.say(fmt::format("resolution {}: about {} triangles, {} file, {} memory, about {:.0f} s", resolution,
                          rounded_count(predicted.triangles), byte_words(predicted.file_bytes),
                          byte_words(predicted.peak_bytes), std::ceil(predicted.seconds)));
  return resolution;
}

void fail_memory(const Program& program, const MeshSizeRequest& request,
                 const std::filesystem::path& output) {
  const double limit = memory_limit(request.max_memory_gb) / 1e9;
  const double predicted = program.summary["predicted"]["peak_bytes"].get<double>() / 1e9;
  throw InputError(fmt::format(
      "{}: the mesh needs more than the {:.3g} GB of --max-memory, and more than the {:.3g} GB that "
      "were predicted; lower the resolution, or raise --max-memory to {:.3g}",
      output.string(), limit, predicted, 1.5 * std::max(limit, predicted)));
}

}  // namespace astrolith
