#include "tasks/prediction/mesh_prediction.h"

#include <fmt/format.h>

#include <algorithm>
#include <thread>

#include "numerics/errors.h"
#include "numerics/memory_use.h"
#include "numerics/processor_clock.h"

namespace astrolith {
namespace {

int threads_of(const PlannedRun& run) {
  return run.threads > 0 ? run.threads : std::max(1, static_cast<int>(std::thread::hardware_concurrency()));
}

}  // namespace

MeshPrediction predict_mesh(const PlannedMesh& mesh, int resolution, const PlannedRun& run,
                            const EstimateBudget& budget) {
  const ProcessorClock clock;
  const double peak_before = static_cast<double>(peak_bytes());
  const MeshEstimate estimate = estimate_region(mesh.field, mesh.recipe, mesh.region, resolution, budget);
  const GaborCost gabor_bricks = gabor_cost(mesh.field, estimate);
  const OutputCost output = output_cost(mesh.output, mesh.use, estimate.triangles);
  const ErosionCost erosion =
      mesh.use.erosion ? erosion_cost(mesh.field, mesh.recipe, estimate) : ErosionCost{};
  const double peak_after = static_cast<double>(peak_bytes());
  give_back_freed_memory();
  const double held = static_cast<double>(resident_bytes());
  const double labels = mesh.use.labels ? label_seconds(mesh.field, mesh.recipe, mesh.region, estimate) : 0.0;
  const double gravity = mesh.use.gravity ? gravity_seconds(mesh.field, mesh.recipe, estimate) : 0.0;
  const EvenCost even = mesh.use.even ? even_cost(estimate) : EvenCost{};
  const double working = std::max({meshing_bytes(estimate), erosion.bytes, even.table_bytes}) +
                         even.recorded_bytes +
                         more_cache_bytes(mesh.field.gabor_caches(), gabor_bricks.bytes, threads_of(run)) +
                         output.memory * estimate.triangles;
  const double times = mesh.use.twice ? 2.0 : 1.0;
  MeshPrediction predicted;
  predicted.triangles = estimate.triangles;
  predicted.file_bytes = output.file * estimate.triangles;
  predicted.peak_bytes = std::max(run.goes_on ? peak_after : peak_before, held + working);
  const double parallel = times * (estimate.seconds + fresh_memory_seconds(estimate) + gabor_bricks.seconds) +
                          erosion.parallel_seconds + labels + gravity + even.seconds;
  const double serial = times * output_seconds_per_triangle() * estimate.triangles + erosion.serial_seconds;
  // Other programs on the machine slow the clock, and threads add up on the processors, so that the lower one
  // is nearer to the clock on idle cores.
  predicted.seconds =
      std::min(run.clock_seconds, run.processor_seconds) + parallel / threads_of(run) + serial;
  predicted.processor_seconds = run.processor_seconds + parallel + serial;
  predicted.own_evaluations = estimate.spent_evaluations;
  predicted.own_seconds = clock.seconds();
  return predicted;
}

void require_memory(const PlannedMesh& mesh, int resolution, const MeshPrediction& predicted, double limit) {
  if (predicted.peak_bytes <= limit) return;
  const bool collected =
      mesh.use.even || output_cost(mesh.output, mesh.use, predicted.triangles).memory > 0.0;
  throw InputError(fmt::format(
      "{}: the mesh of about {} triangles at resolution {} needs {:.3g} GB of memory, more than {:.3g} GB; "
      "lower the resolution, raise --max-memory{}",
      mesh.output.string(), rounded_count(predicted.triangles), resolution, predicted.peak_bytes / 1e9,
      limit / 1e9, collected ? ", or write .ply without --preview and --even, which is streamed" : ""));
}

}  // namespace astrolith
