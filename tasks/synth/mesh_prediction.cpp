#include "tasks/synth/mesh_prediction.h"

#include <fmt/format.h>

#include <algorithm>
#include <span>

#include "geometry/io/mesh_format.h"
#include "geometry/io/ply_stream_writer.h"
#include "gravity/polyhedron_gravity.h"
#include "gravity/vertical_directions.h"
#include "numerics/errors.h"
#include "numerics/memory_use.h"
#include "numerics/parallel_for.h"
#include "numerics/portable_double.h"
#include "numerics/process_limits.h"
#include "synthesis/field/field_mesh.h"
#include "synthesis/field/field_tables.h"
#include "synthesis/finish/erosion.h"
#include "synthesis/gabor/gabor_bricks.h"
#include "tasks/job/words.h"

namespace astrolith {
namespace {

// Seconds of one processor for a triangle and its half vertex to be checked, written and hashed.
constexpr double kOutputSeconds = 1.2e-7;
// Memory of the mesher and of the check of its mesh: blocks, narrowed fields, triangles and vertices of
// layers.
double meshing_bytes(const MeshEstimate& mesh) {
  constexpr double kNode = sizeof(BlockNode<FieldBlock>) + 96.0;  // and what the allocator adds to its lists
  // Links, counts and parents of the half vertex of a triangle, and what growing arrays leave behind.
  constexpr double kCheck = 0.5 * (64.0 + 4.0 + 8.0) + 26.0;
  if (!(mesh.blocks > 0.0)) return 0.0;
  const double block_triangles = mesh.triangles / mesh.blocks;
  // Three layers keep the memory of the largest that they held, while the nodes of the next are culled.
  return mesh.layer_blocks *
         (3.0 * (sizeof(LayerBlock<kBlockCells>) + block_triangles * kCheck) +
          3.0 * (mesh.list_bytes + kNode) + block_triangles * (sizeof(Triangle) + 0.5 * sizeof(MeshVertex)));
}

// The bricks of Gabor impulses that a mesh draws.
struct BrickCost {
  double bytes = 0.0;    // that the caches hold at the end, beyond what they hold now
  double seconds = 0.0;  // of one processor
};

// From the bricks that the estimate has drawn. A probe draws the bricks that reach its column, so that a
// brick which k probes need has been drawn with the probability 1 - exp(-k).
BrickCost estimate_bricks(const ImplicitField& field, const MeshEstimate& mesh, int threads) {
  BrickCost cost;
  if (mesh.probes == 0) return cost;  // all bricks have been drawn
  const FieldView& view = field.tables();
  const std::span<const ImpulseList> lists = view.arrays.span(view.gabor_lists);
  const std::vector<GaborCacheUse> caches = field.gabor_caches();
  const std::vector<double> brick_seconds = field.gabor_brick_seconds();
  for (std::size_t i = 0; i < lists.size(); ++i) {
    if (!(caches[i].drawn > 0.0)) continue;  // under a mask, or drawn for each point
    const GaborSurfaceNoise& noise = *view.layers[lists[i].layer].noise.get_if<GaborSurfaceNoise>();
    const SurfaceBand& band = view.arrays[noise.bands][lists[i].element];
    const double block = kBlockCells * mesh.step;
    const double reached = double{band.cell} * kBrickCells + 2.0 * double{band.reach};
    const double seen = (reached + 2.0 * block) * (reached + 2.0 * block) * mesh.probes / mesh.area;
    const double bricks = caches[i].drawn / (1.0 - portable::exp(-seen));
    const double bytes = bricks * caches[i].drawn_bytes / caches[i].drawn;
    // Bricks that find no room are drawn anew in each layer of blocks that needs them.
    const double two_layer_bytes = bytes * std::min((reached + 3.0 * block) / field.bounds().extent().z, 1.0);
    const double draws =
        two_layer_bytes <= 0.9 * kMostCacheBytes ? 1.0 : std::max(reached / block + 1.0, 1.0);
    // The heaps of two or more threads have gaps.
    const double kept = bytes > kMostCacheBytes ? (threads > 1 ? 1.25 : 1.1) * kMostCacheBytes : bytes;
    cost.bytes += std::max(kept - caches[i].held_bytes, 0.0);
    cost.seconds += brick_seconds[i] * bricks * draws;
  }
  return cost;
}

// Seconds of one processor.
template <typename Work>
double timed(const Work& work) {
  double seconds = 0.0;
  on_one_thread([&] {
    const ProcessorClock clock;
    work();
    seconds = clock.seconds();
  });
  return seconds;
}

// How much more a triangle costs in a mesh of `ratio` times as many, if each doubling adds `more` to it.
double growth(double ratio, double more) { return 1.0 + more * portable::log(ratio) / portable::log(2.0); }

// What an erosion adds.
struct ErosionCost {
  double vertical_seconds = 0.0, slide_seconds = 0.0;
  double bytes = 0.0;  // of the gravity that it slides against, beyond its tables
};

ErosionCost estimate_erosion(const MeshPart& part, const MeshEstimate& mesh) {
  constexpr int kCoarser = 5, kFewestCells = 16, kMostCells = 64, kGravityCells = 48;
  constexpr double kDoublingGrowth = 0.08, kBytesPerFacet = 1250.0, kSecondsPerVertical = 8e-8;
  const Erosion& erosion = *part.recipe.erosion;
  const int cells = std::clamp(mesh.resolution / kCoarser, kFewestCells, kMostCells);
  TriangleMesh coarse = make_coarse_mesh(part.field, cells);
  if (coarse.triangles.empty()) return {};
  std::vector<Vec3d> up;
  ErosionCost cost;
  // Gravity is that of a lattice of some cells; each triangle then adds a little.
  const double finer = std::max(std::min(kGravityCells, mesh.resolution) / double(cells), 1.0);
  cost.vertical_seconds = finer * finer * timed([&] {
                            up = vertical_directions(coarse, {erosion.density, erosion.rotation_period});
                          }) +
                          kSecondsPerVertical * mesh.triangles;
  const double ratio = std::max(mesh.triangles / double(coarse.triangles.size()), 1.0);
  cost.slide_seconds = ratio * growth(ratio, kDoublingGrowth) *
                       timed([&] { erode(coarse, up, erosion.talus_angle, erosion.iterations); });
  const double lattice = std::min(kGravityCells / double(mesh.resolution), 1.0);
  cost.bytes = std::max(kBytesPerFacet * lattice * lattice - kErosionTables, 0.0) * mesh.triangles;
  return cost;
}

// Gravity at all vertices, from some vertices of the coarse mesh.
double gravity_seconds(const TriangleMesh& coarse, const MeshEstimate& mesh) {
  constexpr std::size_t kMostPoints = 400;
  constexpr double kTolerance = 1e-6, kDoublingGrowth = 0.058;
  if (coarse.vertices.empty()) return 0.0;
  std::vector<Vec3d> points;
  const std::size_t stride = coarse.vertices.size() / kMostPoints + 1;
  for (std::size_t i = 0; i < coarse.vertices.size(); i += stride) points.push_back(coarse.vertices[i]);
  const double vertices = 0.5 * mesh.triangles;
  const double ratio = std::max(vertices / double(coarse.vertices.size()), 1.0);
  const PolyhedronGravity gravity(coarse);
  return vertices / double(points.size()) * growth(ratio, kDoublingGrowth) *
         timed([&] { gravity.at(points, kTolerance); });
}

int thread_count(const PlannedRun& run) { return run.threads > 0 ? run.threads : usable_processors(); }

}  // namespace

MeshPrediction predict_mesh(const MeshJob& mesh, const MeshPart& part, const PlannedRun& run) {
  const double start = processor_seconds();
  const double peak_before = static_cast<double>(peak_bytes());
  const MeshSpec& spec = mesh.spec;
  MeshEstimator estimator(part);
  const MeshEstimate estimate =
      estimator.at(spec.triangles > 0.0 ? estimator.resolution_for(spec.triangles) : spec.resolution);
  const BrickCost bricks = estimate_bricks(part.field, estimate, thread_count(run));
  const MeshCost cost = estimate_cost(mesh, part.recipe);
  const ErosionCost erosion = part.recipe.erosion ? estimate_erosion(part, estimate) : ErosionCost{};
  const double gravity = spec.gravity.empty() ? 0.0 : gravity_seconds(estimator.coarse(), estimate);
  const double peak_after = static_cast<double>(peak_bytes());
  give_back_freed_memory();
  const double working =
      std::max({meshing_bytes(estimate), erosion.bytes, cost.table_bytes * estimate.triangles}) +
      bricks.bytes + cost.held_bytes * estimate.triangles + cost.map_bytes;
  MeshPrediction predicted;
  predicted.resolution = estimate.resolution;
  predicted.triangles = estimate.triangles;
  predicted.file_bytes = cost.file_bytes * estimate.triangles;
  predicted.peak_bytes =
      std::max(run.goes_on ? peak_after : peak_before, static_cast<double>(resident_bytes()) + working);
  const double parallel = (cost.times + cost.shares) * estimate.seconds + cost.times * bricks.seconds +
                          erosion.vertical_seconds + gravity;
  const double serial = cost.times * kOutputSeconds * estimate.triangles + erosion.slide_seconds;
  // Other programs on the machine slow the clock, and threads add up on the processors, so that the lower one
  // is nearer to the clock on idle cores.
  predicted.seconds =
      std::min(run.clock_seconds, run.processor_seconds) + parallel / thread_count(run) + serial;
  predicted.processor_seconds = run.processor_seconds + parallel + serial;
  predicted.own_evaluations = estimate.own_evaluations;
  predicted.own_seconds = processor_seconds() - start;
  return predicted;
}

void require_memory(const MeshJob& mesh, const Recipe& recipe, const MeshPrediction& predicted,
                    double limit) {
  if (predicted.peak_bytes <= limit) return;
  const bool collected = estimate_cost(mesh, recipe).held_bytes > 0.0;
  throw InputError(fmt::format(
      "{}: the mesh of about {} triangles at resolution {} needs {:.3g} GB of memory, more than {:.3g} GB; "
      "lower the resolution, raise --max-memory{}",
      mesh.sinks.file.string(), rounded_count(predicted.triangles), predicted.resolution,
      predicted.peak_bytes / 1e9, limit / 1e9,
      collected ? ", or write .ply without --preview and --even, which is streamed" : ""));
}

int choose_resolution(Job& job, const MeshJob& mesh, const MeshPart& part) {
  // Below this resolution a mesh is small and quick: predicting would cost more than it tells.
  constexpr int kWorthPredicting = 256;
  const MeshSpec& spec = mesh.spec;
  const bool small = mesh.max_memory_gb <= 0.0 && spec.resolution < kWorthPredicting;
  if (spec.triangles <= 0.0 && !mesh.only_predict && small) return spec.resolution;

  const MeshPrediction predicted =
      predict_mesh(mesh, part, {thread_limit(), job.seconds(), job.processor_seconds(), !mesh.only_predict});
  const int resolution = predicted.resolution;
  job.summary["resolution"] = resolution;
  job.summary["predicted"] = {{"triangles", predicted.triangles},
                              {"file_bytes", predicted.file_bytes},
                              {"peak_bytes", predicted.peak_bytes},
                              {"seconds", predicted.seconds},
                              {"processor_seconds", predicted.processor_seconds},
                              {"own_seconds", predicted.own_seconds},
                              {"own_evaluations", predicted.own_evaluations}};
  require_memory(mesh, part.recipe, predicted, memory_limit(mesh.max_memory_gb));
  const std::string line = fmt::format("resolution {}: about {} triangles, {} file, {} memory, {}",
                                       resolution, rounded_count(predicted.triangles),
                                       byte_words(predicted.file_bytes), byte_words(predicted.peak_bytes),
                                       seconds_words(predicted.seconds, predicted.processor_seconds));
  if (!mesh.only_predict) job.say(line);
  if (mesh.only_predict && !job.quiet) job.print_result(line + "\n");
  return resolution;
}

void fail_memory(const Job& job, const MeshJob& mesh) {
  const double limit = memory_limit(mesh.max_memory_gb) / 1e9;
  const double predicted = job.summary["predicted"]["peak_bytes"].get<double>() / 1e9;
  throw InputError(fmt::format(
      "{}: the mesh needs more than the {:.3g} GB of --max-memory, and more than the {:.3g} GB that "
      "were predicted; lower the resolution, or raise --max-memory to {:.3g}",
      mesh.sinks.file.string(), limit, predicted, 1.5 * std::max(limit, predicted)));
}

}  // namespace astrolith
