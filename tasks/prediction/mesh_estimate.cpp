#include "tasks/prediction/mesh_estimate.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "numerics/errors.h"
#include "numerics/one_thread.h"
#include "synthesis/field/field_mesh.h"
#include "synthesis/field/field_tables.h"

namespace astrolith {
namespace {

// Up to this resolution a mesh is made: probes would take as long.
constexpr int kSmall = 64;

constexpr double kFar = 1e300;
const Box kEverywhere{{-kFar, -kFar, -kFar}, {kFar, kFar, kFar}};

SampleGrid grid_of(const ImplicitField& field, const Region& region, int resolution) {
  return region.is_patch ? make_patch_grid(region.size, resolution)
                         : make_sample_grid(field.bounds(), resolution);
}

// The part of space in which the mesh lies: the cube of a patch, the slab of a tile.
Box space_of(const ImplicitField& field, const Region& region, int resolution) {
  const Vec3d half = 0.5 * region.size * Vec3d{1, 1, 1};
  if (region.is_patch) return {-1.0 * half, half};
  Box slab = kEverywhere;
  if (region.tile.count <= 1) return slab;
  const SampleGrid grid = make_sample_grid(field.bounds(), resolution);
  const CellWindow window = window_of_tile<kBlockCells>(grid, region.tile);
  slab.min.z = double{grid.z(window.first[2] - 1)};
  slab.max.z = double{grid.z(window.last[2])};
  return slab;
}

bool has_impulses(const FieldView& view) { return view.gabor_lists.count > 0 || view.spot_lists.count > 0; }

// A coarse mesh of a field with spots or Gabor noise would draw all impulses of a fine one, so that the body
// without its layers stands for it.
ImplicitField base_of(const ImplicitField& field, const Recipe& recipe) {
  if (!has_impulses(field.tables())) return field;
  Recipe bare = recipe;
  bare.layers.clear();
  return ImplicitField(bare);
}

void set_layers(const ProbedSurface& surface, const SampleGrid& grid, MeshEstimate& estimate) {
  const double side = kBlockCells * grid.step;
  const double places =
      std::ceil(grid.cells[0] / double(kBlockCells)) * std::ceil(grid.cells[1] / double(kBlockCells));
  estimate.blocks_of_layer = std::min(estimate.blocks * surface.largest_share(side), places);
}

}  // namespace

MeshEstimator::MeshEstimator(const ImplicitField& field, const Recipe& recipe, const Region& region)
    : field_(field), region_(region), base_(base_of(field, recipe)) {}

void MeshEstimator::make_coarse(int cells) {
  if (cells <= coarse_cells_) return;
  MeshStatistics made;
  // Columns at the border of a patch hold a part of the surface beside it.
  constexpr double kWider = 1.25;
  coarse_ = region_.is_patch ? coarse_mesh_of(PatchField(base_, region_.center, region_.axes),
                                              kWider * region_.size, cells, &made)
                             : coarse_mesh_of(base_, cells, &made);
  coarse_cells_ = cells;
  coarse_step_ = made.step;
  evaluations_ += double(made.evaluations);
}

ProbeFigures MeshEstimator::probe(const ProbedSurface& surface, int resolution, int count) {
  const FieldView& view = field_.tables();
  const double reach = has_impulses(view) ? std::max(coarse_step_, field_.height_bound()) : coarse_step_;
  // The impulses of columns that were probed before have been drawn.
  const bool twice = view.gabor_lists.count > 0 && count > most_probes_;
  const ProbedMesh mesh{surface, grid_of(field_, region_, resolution).step, reach, twice};
  most_probes_ = std::max(most_probes_, count);
  const ProbeFigures figures =
      region_.is_patch ? probe_surface(PatchField(field_, region_.center, region_.axes), mesh, count)
                       : probe_surface(field_, mesh, count);
  evaluations_ += figures.evaluations;
  last_ = {mesh.step, count, figures};
  return figures;
}

// What `count` probes find, or what as many found at cells of nearly this size.
ProbeFigures MeshEstimator::probe_or_known(const ProbedSurface& surface, int resolution, int count) {
  constexpr double kNear = 0.05;
  const double ratio = last_.step / grid_of(field_, region_, resolution).step;
  if (region_.tile.count > 1 || last_.count < count || std::fabs(ratio - 1.0) > kNear)
    return probe(surface, resolution, count);
  ProbeFigures figures = last_.figures;
  for (double* of_area : {&figures.triangles, &figures.blocks, &figures.seconds}) *of_area *= ratio * ratio;
  return figures;
}

MeshEstimate MeshEstimator::made_at(int resolution) {
  MeshCollector collector;
  MeshStatistics made;
  double seconds = 0.0;
  on_one_thread([&] {
    const ProcessorClock clock;
    made = mesh_region(field_, region_, resolution, collector, {});
    seconds = clock.seconds();
  });
  coarse_ = std::move(collector.mesh);
  coarse_cells_ = 0;  // the next estimate makes another one
  const ProbedSurface surface(coarse_, kEverywhere);
  MeshEstimate estimate{resolution, made.step, surface.area(), double(made.triangles),
                        double(made.active_blocks)};
  estimate.seconds = seconds;
  estimate.own_evaluations = evaluations_ + double(made.evaluations);
  set_layers(surface, grid_of(field_, region_, resolution), estimate);
  return estimate;
}

MeshEstimate MeshEstimator::at(int resolution) {
  if (resolution <= kSmall) return made_at(resolution);
  // Coarse cells of eight cells, and one probe for 6,400 cells of a side of the body's box: together these
  // take some 3 % of the mesh.
  constexpr int kCoarser = 8, kFewestCells = 24, kMostCells = 64, kFewestProbes = 12, kMostProbes = 64;
  constexpr double kCellsOfProbe = 6400.0;
  make_coarse(std::clamp(resolution / kCoarser, kFewestCells, kMostCells));
  const SampleGrid grid = grid_of(field_, region_, resolution);
  MeshEstimate estimate{resolution, grid.step};
  const ProbedSurface surface(coarse_, space_of(field_, region_, resolution));
  if (!surface.empty()) {
    const double wanted = double(resolution) * resolution / kCellsOfProbe;
    const int probes = std::clamp(int(wanted), kFewestProbes, kMostProbes);
    const ProbeFigures of_area = probe_or_known(surface, resolution, probes);
    estimate.area = surface.area();
    estimate.triangles = estimate.area * of_area.triangles;
    estimate.blocks = estimate.area * of_area.blocks;
    estimate.seconds = estimate.area * of_area.seconds;
    estimate.list_bytes = of_area.list_bytes;
    estimate.probes = most_probes_;
    set_layers(surface, grid, estimate);
  }
  estimate.own_evaluations = evaluations_;
  return estimate;
}

namespace {

// The resolution that has so many triangles, where `resolution` has `found`.
int nearer_resolution(int resolution, double found, double triangles) {
  const double better = 2.0 + (resolution - 2) * std::sqrt(triangles / found);
  return static_cast<int>(std::lround(std::clamp(better, double(kMinResolution), double(kMaxResolution))));
}

[[noreturn]] void fail_as_too_small() {
  throw WorkError("mesher: the surface is too small to tell its size; give a resolution");
}

}  // namespace

int MeshEstimator::counted_resolution(int resolution, double triangles) {
  constexpr int kMostCounts = 4;
  for (int k = 0; k < kMostCounts; ++k) {
    const double found = made_at(resolution).triangles;
    if (!(found > 0.0)) fail_as_too_small();
    const int next = nearer_resolution(resolution, found, triangles);
    if (next == resolution) break;
    resolution = next;
  }
  return resolution;
}

int MeshEstimator::resolution_for(double triangles) {
  constexpr int kCells = 64, kTriedProbes = 24, kProbes = 96;
  constexpr int kMostCounted = 32;  // cells of meshes that are counted sooner than probed
  // A plane in a lattice has this many triangles on a square of the lattice's edge, in the mean over all
  // directions.
  constexpr double kOfSquare = 3.0;
  make_coarse(kCells);
  const ProbedSurface surface(coarse_, region_.is_patch ? space_of(field_, region_, kCells) : kEverywhere);
  if (surface.empty()) fail_as_too_small();
  const double step = grid_of(field_, region_, kCells).step;
  double found = surface.area() * kOfSquare / (step * step);
  int resolution = nearer_resolution(kCells, found, triangles);
  if (resolution <= kMostCounted && region_.tile.count == 1) return counted_resolution(resolution, triangles);
  for (const int probes : {kTriedProbes, kProbes}) {
    found = surface.area() * probe(surface, resolution, probes).triangles;
    if (!(found > 0.0)) fail_as_too_small();
    if (probes == kTriedProbes) resolution = nearer_resolution(resolution, found, triangles);
  }
  resolution = nearer_resolution(resolution, found, triangles);
  if (resolution == kMaxResolution && found < 0.9 * triangles) {
    throw InputError(
        fmt::format("triangles: the finest mesh there is, resolution {}, has about {}; ask for fewer",
                    resolution, rounded_count(found)));
  }
  return resolution;
}

}  // namespace astrolith
