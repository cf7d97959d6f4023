#include "tasks/synth/mesh_estimate.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "numerics/errors.h"
#include "numerics/portable_double.h"
#include "numerics/processor_clock.h"
#include "synthesis/field/field_mesh.h"
#include "synthesis/field/field_tables.h"
#include "tasks/job/words.h"

namespace astrolith {
namespace {

// Up to this resolution a mesh is made: probes would take as long.
constexpr int kSmall = 64;

constexpr double kFar = 1e300;
const Box kEverywhere{{-kFar, -kFar, -kFar}, {kFar, kFar, kFar}};

bool has_impulses(const FieldView& view) { return view.gabor_lists.count > 0 || view.spot_lists.count > 0; }

// A coarse mesh of a field with spots or Gabor noise would draw all impulses of a fine one, so that the body
// without its layers stands for it.
ImplicitField make_base(const ImplicitField& field, const Recipe& recipe) {
  if (!has_impulses(field.tables())) return field;
  Recipe bare = recipe;
  bare.layers.clear();
  return ImplicitField(bare);
}

void set_layers(const ProbedSurface& surface, const SampleGrid& grid, MeshEstimate& estimate) {
  const double side = kBlockCells * grid.step;
  const double places =
      std::ceil(grid.cells[0] / double(kBlockCells)) * std::ceil(grid.cells[1] / double(kBlockCells));
  estimate.layer_blocks = std::min(estimate.blocks * surface.largest_share(side), places);
}

// What a mesh of nearly as many cells tells of one of this resolution.
MeshEstimate scaled(MeshEstimate counted, int resolution, double step) {
  const double ratio = counted.step / step;
  counted.resolution = resolution;
  counted.step = step;
  for (double* per_area : {&counted.triangles, &counted.blocks, &counted.seconds}) *per_area *= ratio * ratio;
  counted.layer_blocks *= ratio;
  return counted;
}

}  // namespace

MeshEstimator::MeshEstimator(const MeshPart& part) : part_(part), base_(make_base(part.field, part.recipe)) {}

SampleGrid MeshEstimator::sample_grid(int resolution) const {
  return region_.is_patch ? make_patch_grid(region_.size, resolution)
                          : make_sample_grid(field_.bounds(), resolution);
}

Box MeshEstimator::mesh_space(int resolution) const {
  const Vec3d half = 0.5 * region_.size * Vec3d{1, 1, 1};
  if (region_.is_patch) return {-1.0 * half, half};
  Box slab = kEverywhere;
  if (region_.tile.count <= 1) return slab;
  const SampleGrid grid = sample_grid(resolution);
  const CellWindow window = tile_window<kBlockCells>(grid, region_.tile);
  slab.min.z = double{grid.z(window.first[2] - 1)};
  slab.max.z = double{grid.z(window.last[2])};
  return slab;
}

void MeshEstimator::make_coarse(int cells) {
  if (cells <= coarse_cells_) return;
  MeshStatistics made;
  // Columns at the border of a patch hold a part of the surface beside it.
  constexpr double kWider = 1.25;
  coarse_ = region_.is_patch ? make_coarse_mesh(PatchField(base_, region_.center, region_.axes),
                                                kWider * region_.size, cells, &made)
                             : make_coarse_mesh(base_, cells, &made);
  coarse_cells_ = cells;
  coarse_step_ = made.step;
  evaluations_ += double(made.evaluations);
}

ProbeFigures MeshEstimator::probe(const ProbedSurface& surface, int resolution, int count) {
  const FieldView& view = field_.tables();
  const double reach = has_impulses(view) ? std::max(coarse_step_, field_.height_bound()) : coarse_step_;
  // The impulses of columns that were probed before have been drawn.
  const bool twice = view.gabor_lists.count > 0 && count > most_probes_;
  const ProbedMesh mesh{surface, sample_grid(resolution).step, reach, twice};
  most_probes_ = std::max(most_probes_, count);
  const ProbeFigures figures =
      region_.is_patch
          ? probe_surface<kBlockCells>(PatchField(field_, region_.center, region_.axes), mesh, count)
          : probe_surface<kBlockCells>(field_, mesh, count);
  evaluations_ += figures.evaluations;
  last_ = {mesh.step, count, figures};
  return figures;
}

// What `count` probes find, or what as many found at cells of nearly this size.
ProbeFigures MeshEstimator::probe_or_known(const ProbedSurface& surface, int resolution, int count) {
  constexpr double kNear = 0.05;
  const double ratio = last_.step / sample_grid(resolution).step;
  if (region_.tile.count > 1 || last_.count < count || std::fabs(ratio - 1.0) > kNear)
    return probe(surface, resolution, count);
  ProbeFigures figures = last_.figures;
  for (double* per_area : {&figures.triangles, &figures.blocks, &figures.seconds}) *per_area *= ratio * ratio;
  return figures;
}

MeshEstimate MeshEstimator::made_at(int resolution) {
  MeshCollector collector;
  const double start = processor_seconds();
  const MeshStatistics made = mesh_part(part_.with_cells(resolution), collector, {});
  evaluations_ += double(made.evaluations);
  coarse_ = std::move(collector.mesh);
  coarse_cells_ = 0;  // the next estimate makes another one
  const ProbedSurface surface(coarse_, kEverywhere);
  MeshEstimate estimate{resolution, made.step, surface.area(), double(made.triangles),
                        double(made.active_blocks)};
  estimate.seconds = processor_seconds() - start;
  estimate.own_evaluations = evaluations_;
  set_layers(surface, sample_grid(resolution), estimate);
  return estimate;
}

MeshEstimate MeshEstimator::at(int resolution) {
  if (counted_.triangles > 0.0) return scaled(counted_, resolution, sample_grid(resolution).step);
  if (resolution <= kSmall) return made_at(resolution);
  // Coarse cells of eight cells, and one probe for 6,400 cells of a side of the body's box: together these
  // take some 3 % of the mesh.
  constexpr int kCoarser = 8, kFewestCells = 24, kMostCells = 64, kFewestProbes = 12, kMostProbes = 64;
  constexpr double kCellsPerProbe = 6400.0;
  make_coarse(std::clamp(resolution / kCoarser, kFewestCells, kMostCells));
  const SampleGrid grid = sample_grid(resolution);
  MeshEstimate estimate{resolution, grid.step};
  const ProbedSurface surface(coarse_, mesh_space(resolution));
  if (!surface.empty()) {
    const double wanted = double(resolution) * resolution / kCellsPerProbe;
    const int probes = std::clamp(int(wanted), kFewestProbes, kMostProbes);
    const ProbeFigures per_area = probe_or_known(surface, resolution, probes);
    estimate.area = surface.area();
    estimate.triangles = estimate.area * per_area.triangles;
    estimate.blocks = estimate.area * per_area.blocks;
    estimate.seconds = estimate.area * per_area.seconds;
    estimate.list_bytes = per_area.list_bytes;
    estimate.probes = most_probes_;
    set_layers(surface, grid, estimate);
  }
  estimate.own_evaluations = evaluations_;
  return estimate;
}

namespace {

// The resolution that has so many triangles, where `resolution` has `found`, and their number grows with this
// power of the cells.
int nearer_resolution(int resolution, double found, double triangles, double power = 2.0) {
  const double better = 2.0 + (resolution - 2) * portable::exp(portable::log(triangles / found) / power);
  return static_cast<int>(std::lround(std::clamp(better, double(kMinResolution), double(kMaxResolution))));
}

// The power of the cells with which the number of triangles grew from one mesh to another. Small meshes say
// little, so that it is held to those of a plane and of the roughest noise.
double growth_power(const MeshEstimate& from, const MeshEstimate& to) {
  constexpr double kPlane = 2.0, kRoughest = 2.6;
  if (from.resolution == to.resolution || !(from.triangles > 0.0)) return kPlane;
  const double cells = (to.resolution - 2.0) / (from.resolution - 2.0);
  return std::clamp(portable::log(to.triangles / from.triangles) / portable::log(cells), kPlane, kRoughest);
}

[[noreturn]] void fail_as_too_small() {
  throw WorkError("mesher: the surface is too small to tell its size; give a resolution");
}

}  // namespace

int MeshEstimator::counted_resolution(MeshEstimate before, int resolution, double triangles) {
  constexpr int kMostCounts = 4;
  constexpr double kSure = 0.15;  // share of the triangles that the law of growth adds or takes surely enough
  for (int k = 0; k < kMostCounts; ++k) {
    counted_ = made_at(resolution);
    if (!(counted_.triangles > 0.0)) fail_as_too_small();
    const int next =
        nearer_resolution(resolution, counted_.triangles, triangles, growth_power(before, counted_));
    if (next == resolution) break;
    resolution = next;
    if (std::fabs(counted_.triangles / triangles - 1.0) < kSure) break;
    before = counted_;
  }
  return resolution;
}

int MeshEstimator::resolution_for(double triangles) {
  constexpr int kCells = 64, kTriedProbes = 24, kProbes = 96;
  constexpr int kMostCounted = 160;  // cells of meshes that are counted sooner than probed
  // A plane in a lattice has this many triangles on a square of the lattice's edge, in the mean over all
  // directions.
  constexpr double kTrianglesPerSquare = 3.0;
  make_coarse(kCells);
  const ProbedSurface surface(coarse_, region_.is_patch ? mesh_space(kCells) : kEverywhere);
  if (surface.empty()) fail_as_too_small();
  const double step = sample_grid(kCells).step;
  double found = surface.area() * kTrianglesPerSquare / (step * step);
  int resolution = nearer_resolution(kCells, found, triangles);
  if (resolution <= kMostCounted && region_.tile.count == 1)
    return counted_resolution({kCells, step, surface.area(), found}, resolution, triangles);
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
