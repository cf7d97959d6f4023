#include "tasks/prediction/mesh_estimate.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <utility>

#include "numerics/errors.h"
#include "synthesis/field/field_mesh.h"
#include "synthesis/field/field_tables.h"
#include "synthesis/mesh/surface_probes.h"

namespace astrolith {
namespace {

// Cells of the first and coarsest mesh, and of the finest one that still counts as coarse.
constexpr int kCoarsest = 24, kFinest = 96;

SampleGrid grid_of(const ImplicitField& field, const Region& region, int resolution) {
  return region.is_patch ? make_patch_grid(region.size, resolution)
                         : make_sample_grid(field.bounds(), resolution);
}

// The slab of space in which a tile of the mesh lies.
Box slab_of(const ImplicitField& field, const Region& region, int resolution) {
  constexpr double kFar = 1e300;
  Box slab{{-kFar, -kFar, -kFar}, {kFar, kFar, kFar}};
  if (region.is_patch || region.tile.count <= 1) return slab;
  const SampleGrid grid = make_sample_grid(field.bounds(), resolution);
  const CellWindow window = window_of_tile<kBlockCells>(grid, region.tile);
  slab.min.z = double{grid.z(window.first[2] - 1)};
  slab.max.z = double{grid.z(window.last[2])};
  return slab;
}

// The field whose coarse mesh is made. A coarse mesh of a field with spots or Gabor noise would draw all
// impulses of a fine one, so that the body without its layers stands for it.
ImplicitField base_of(const ImplicitField& field, const Recipe& recipe) {
  const FieldView& view = field.tables();
  if (view.gabor_lists.count == 0 && view.spot_lists.count == 0) return field;
  Recipe bare = recipe;
  bare.layers.clear();
  return ImplicitField(bare);
}

TriangleMesh coarse_mesh_in(const ImplicitField& base, const Region& region, int cells,
                            double* evaluations = nullptr) {
  MeshStatistics made;
  TriangleMesh mesh = region.is_patch ? coarse_mesh_of(PatchField(base, region.center, region.axes),
                                                       region.size, cells, &made)
                                      : coarse_mesh_of(base, cells, &made);
  if (evaluations != nullptr) *evaluations += static_cast<double>(made.evaluations);
  return mesh;
}

// Probes of the mesh of one region, at one resolution, on a coarse surface.
class RegionProbes {
 public:
  // `base` is the field whose coarse mesh tells where the surface is.
  RegionProbes(const ImplicitField& field, const ImplicitField& base, const Region& region, int resolution)
      : field_(field), base_(base), region_(region), resolution_(resolution) {}

  // Makes the coarse surface with this many cells.
  void look_from(int cells) {
    const ProcessorClock clock;
    cells_ = std::min(cells, resolution_);
    surface_ = ProbedSurface(coarse_mesh_in(base_, region_, cells_, &evaluations_),
                             slab_of(field_, region_, resolution_));
    seconds_ = clock.seconds();
  }

  // Takes the coarse surface of other probes of this region, made with as many cells as look_from would.
  void look_at(ProbedSurface surface, int cells) {
    cells_ = cells;
    surface_ = std::move(surface);
  }

  void add(int count, double with_neighbour, bool costs = true) {
    const double cell = grid_of(field_, region_, cells_).step;
    const bool gabor = field_.tables().gabor_lists.count > 0;
    const double reach =
        base_.tables().num_layers < field_.tables().num_layers ? std::max(cell, field_.height_bound()) : cell;
    const ProbedMesh mesh{surface_, grid_of(field_, region_, resolution_).step, reach, with_neighbour, gabor,
                          costs};
    if (region_.is_patch) {
      probe(PatchField(field_, region_.center, region_.axes), mesh, sums_.probes, count, sums_);
    } else {
      probe(field_, mesh, sums_.probes, count, sums_);
    }
  }

  int cells() const { return cells_; }
  double coarse_seconds() const { return seconds_; }
  double coarse_evaluations() const { return evaluations_; }  // of all coarse surfaces so far
  const ProbedSurface& surface() const { return surface_; }
  const ProbeSums& sums() const { return sums_; }

 private:
  const ImplicitField& field_;
  const ImplicitField& base_;
  const Region& region_;
  int resolution_;
  int cells_ = 0;
  double seconds_ = 0.0, evaluations_ = 0.0;
  ProbedSurface surface_;
  ProbeSums sums_;
};

MeshEstimate sample_region(const ImplicitField& field, const Region& region, int resolution,
                           const SampleSize& size) {
  return region.is_patch
             ? sample_patch(PatchField(field, region.center, region.axes), region.size, resolution, size)
             : sample_field(field, field.bounds(), resolution, region.tile, size);
}

// Makes a coarse surface, as fine as the seconds allow, of which `spent` are gone. Returns the seconds that
// it took, with these.
double take_surface(RegionProbes& probes, int resolution, double allowed, double spent) {
  probes.look_from(kCoarsest);
  spent += probes.coarse_seconds();
  const double left = std::max(allowed - spent, 0.0);
  const double finer = kCoarsest * std::sqrt(left / std::max(probes.coarse_seconds(), 1e-5));
  const int cells = std::min({int(std::min(finer, double(kFinest))), kFinest, resolution});
  if (cells < kCoarsest * 5 / 4) return spent;
  probes.look_from(cells);
  return spent + probes.coarse_seconds();
}

}  // namespace

MeshEstimate estimate_region(const ImplicitField& field, const Recipe& recipe, const Region& region,
                             int resolution, const EstimateBudget& budget) {
  constexpr double kOfSample = 0.25, kOfSurface = 0.4;  // parts of what the estimate may take
  constexpr int kAtOnce = 6, kFewestProbes = 4, kMostProbes = 1024;
  const bool gabor = field.tables().gabor_lists.count > 0;
  const MeshEstimate sample = estimate_within(
      [&](const SampleSize& size) { return sample_region(field, region, resolution, size); }, gabor,
      {budget.first_squares, budget.first_blocks, kOfSample * budget.share, kOfSample * budget.free_seconds});
  if (sample.whole) return sample;
  const auto allowed = [&](const MeshEstimate& estimate) {
    return std::max(budget.share * estimate.seconds, budget.free_seconds);
  };
  const ProcessorClock clock_of_base;
  const ImplicitField base = base_of(field, recipe);
  const double of_base = clock_of_base.seconds();
  RegionProbes probes(field, base, region, resolution);
  const double of_surface = take_surface(probes, resolution, kOfSurface * allowed(sample), of_base);
  MeshEstimate estimate = sample;
  estimate.spent_seconds += of_surface;
  estimate.spent_evaluations += probes.coarse_evaluations();
  if (probes.surface().empty()) return estimate;
  for (int more = std::min(kAtOnce, budget.first_probes); more >= kFewestProbes;) {
    probes.add(more, sample.with_neighbour);
    estimate = improved_by_probes(sample, probes.surface(), probes.sums());
    estimate.spent_seconds += of_surface;
    estimate.spent_evaluations += probes.coarse_evaluations();
    const double of_probe = probes.sums().spent_seconds / probes.sums().probes;
    const auto number_within = [&](double seconds) {
      const double left = seconds - estimate.spent_seconds;
      return int(std::clamp(left / std::max(of_probe, 1e-6), 0.0, 1e6));
    };
    const int done = probes.sums().probes;
    const int first =
        std::min(budget.first_probes - done, number_within(budget.most_share * estimate.seconds));
    more = std::min({std::max(number_within(allowed(estimate)), first), 3 * done, kMostProbes - done});
  }
  return estimate;
}

TriangleMesh coarse_region(const ImplicitField& field, const Recipe& recipe, const Region& region,
                           int cells) {
  return coarse_mesh_in(base_of(field, recipe), region, cells);
}

int resolution_for_triangles(const ImplicitField& field, const Recipe& recipe, const Region& region,
                             double triangles) {
  const ImplicitField base = base_of(field, recipe);
  constexpr int kCells = 64, kProbes = 256, kProbesOfGabor = 128, kFirst = 96, kMostSteps = 3;
  constexpr double kNearEnough = 0.02;
  const bool gabor = field.tables().gabor_lists.count > 0;
  const Region whole = region.is_patch ? region : Region{};
  int resolution = kFirst;
  double found = 0.0;
  ProbedSurface surface;  // the region has no tile, so that steps with as many cells share it
  int cells = 0;
  for (int step = 0; step < kMostSteps; ++step) {
    RegionProbes probes(field, base, whole, resolution);
    if (cells == std::min(kCells, resolution)) {
      probes.look_at(surface, cells);
    } else {
      probes.look_from(kCells);
      surface = probes.surface();
      cells = probes.cells();
    }
    if (!probes.surface().empty()) probes.add(gabor ? kProbesOfGabor : kProbes, 1.0, false);
    found = probes.surface().area() * probes.sums().triangles_per_area / std::max(probes.sums().probes, 1);
    if (!(found > 0.0)) {
      throw WorkError("mesher: the surface is too small to tell its size; give a resolution");
    }
    const double better = 2.0 + (resolution - 2) * std::sqrt(triangles / found);
    const int next =
        static_cast<int>(std::lround(std::clamp(better, double(kMinResolution), double(kMaxResolution))));
    if (next == resolution || std::fabs(found / triangles - 1.0) < kNearEnough) break;
    resolution = next;
  }
  if (resolution == kMaxResolution && found < 0.9 * triangles) {
    throw InputError(
        fmt::format("triangles: the finest mesh there is, resolution {}, has about {}; ask for fewer",
                    resolution, rounded_count(found)));
  }
  return resolution;
}

}  // namespace astrolith
