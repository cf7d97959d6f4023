#include "tasks/synth/mesh_region.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <optional>
#include <span>
#include <vector>

#include "cuda/mesher/gpu_mesher.h"
#include "cuda/mesher/mesh_batch.h"
#include "numerics/errors.h"
#include "numerics/interval.h"
#include "synthesis/field/field_mesh.h"

namespace astrolith {
namespace {

// The finest cell of a body made by operations, as a fraction of its largest coordinate.
constexpr double kFinestCell = 0x1p-15;

// The most cells along the longest side of a mesh that only looks whether there is a surface.
constexpr int kLookAround = 64;

// The point of the surface that Newton's steps along the gradient lead to; none where they do not converge.
std::optional<Vec3d> down_the_gradient(const ImplicitField& field, Vec3d p) {
  const double size = norm(field.bounds().extent());
  for (int step = 0; step < 64; ++step) {
    const double value = field.value(p);
    if (std::abs(value) <= 1e-6 * size) return p;
    const Vec3d gradient = field.gradient(p);
    p -= value / squared_norm(gradient) * gradient;
    if (!std::isfinite(squared_norm(p))) return {};
  }
  return {};
}

// A point of the surface near p. Far from the body, where the field is flat, it is the nearest vertex of a
// coarse mesh.
Vec3d nearby_surface_point(const ImplicitField& field, const Vec3d& p) {
  if (const std::optional<Vec3d> near = down_the_gradient(field, p)) return *near;
  MeshCollector coarse;
  mesh_field(field, field.bounds(), kLookAround, coarse);
  const std::vector<Vec3d>& places = coarse.mesh.vertices;
  const auto nearest = std::min_element(places.begin(), places.end(), [&](const Vec3d& a, const Vec3d& b) {
    return squared_norm(a - p) < squared_norm(b - p);
  });
  return nearest == places.end() ? p : down_the_gradient(field, *nearest).value_or(*nearest);
}

// A body made by operations is evaluated in float coordinates of its frame. Finer cells would show their
// rounding.
void check_cells(const ImplicitField& field, const Region& region, int resolution) {
  const double finest = kFinestCell * largest_coordinate(field.bounds());
  const double cell = region.size / resolution;
  if (cell >= finest) return;
  throw InputError(
      fmt::format("patch: body.operations: a combined body has cells of {:.3g} at least, these would be "
                  "{:.3g}; lower the resolution or take a larger cube",
                  finest, cell));
}

// Whether a mesh of so many cells shows nothing of the recipe's surface.
bool is_empty(const Recipe& recipe, const std::filesystem::path& file, int cells) {
  const ImplicitField field(recipe, file.string());
  if (field.bounds().empty()) return true;
  MeshDiscard sink;
  return mesh_field(field, field.bounds(), cells, sink).triangles == 0;
}

// The layer that takes away what the body and the layers before it have of a surface; -1 where there is none.
int emptying_layer(const Recipe& recipe, const std::filesystem::path& file, int cells) {
  Recipe part = recipe;
  if (!is_empty(part, file, cells)) return -1;
  for (std::size_t i = recipe.layers.size(); i > 0; --i) {
    part.layers.resize(i - 1);
    if (!is_empty(part, file, cells)) return static_cast<int>(i) - 1;
  }
  return -1;
}

// Passes on a mesh whose coordinates lie along the axes of the ground, with coordinates of the body's axes.
class TurnedMesh : public MeshSink {
 public:
  TurnedMesh(const PatchPlace& place, MeshSink& sink) : place_(place), sink_(sink) {}
  void add_vertices(std::span<const MeshVertex> vertices) override {
    turned_.assign(vertices.begin(), vertices.end());
    for (MeshVertex& v : turned_) v = {place_.along_body(v.position), place_.along_body(v.normal)};
    sink_.add_vertices(turned_);
  }
  void add_triangles(std::span<const Triangle> triangles) override { sink_.add_triangles(triangles); }

 private:
  PatchPlace place_;
  MeshSink& sink_;
  std::vector<MeshVertex> turned_;  // kept for its memory
};

MeshStatistics mesh_cube(const ImplicitField& field, const Region& region, int resolution, MeshSink& sink,
                         const Progress& progress, MeshingDevice device) {
  const PatchField patch(field, region.center, region.axes);
  const auto mesh = [&](MeshSink& to) {
    return device == MeshingDevice::kGpu ? mesh_patch_on_gpu(patch, region.size, resolution, to, progress)
                                         : mesh_patch(patch, region.size, resolution, to, progress);
  };
  if (!region.axes) return mesh(sink);
  TurnedMesh turned(patch.place(), sink);
  return mesh(turned);
}

}  // namespace

Region patch_region(const Vec3d& center, double side) {
  Region region;
  region.is_patch = true;
  region.center = center;
  region.size = side;
  if (!(side >= kMinPositive) || !(side <= kMaxNumber) ||
      !(squared_norm(center) <= kMaxNumber * kMaxNumber)) {
    throw InputError("patch: has no centre or no side above 0; write X Y Z SIDE in the recipe's length unit");
  }
  return region;
}

Region tile_region(int number, int count) {
  if (number < 1 || number > count) {
    throw InputError(
        fmt::format("tile: {}/{} is no tile; write I/N with I from 1 to N, such as 3/16", number, count));
  }
  Region region;
  region.tile = {number - 1, count};
  return region;
}

std::string lacking_on_gpu(const ImplicitField& field, const Region& region, int resolution) {
  if (region.is_patch) {
    const PatchPlace place(region.center, region.axes);
    return obstacle_on_gpu(field.patch_tables(), block_side(grid_of_patch(place, region.size, resolution)));
  }
  return obstacle_on_gpu(field.tables(), block_side(grid_of_field(field.bounds(), resolution)));
}

MeshStatistics mesh_region(const ImplicitField& field, const Region& region, int resolution, MeshSink& sink,
                           const Progress& progress, MeshingDevice device) {
  if (region.is_patch && !field.has_local_form()) check_cells(field, region, resolution);
  if (region.is_patch) return mesh_cube(field, region, resolution, sink, progress, device);
  return device == MeshingDevice::kGpu
             ? mesh_field_on_gpu(field, field.bounds(), resolution, sink, progress, region.tile)
             : mesh_field(field, field.bounds(), resolution, sink, progress, region.tile);
}

EvenStatistics even_region(const ImplicitField& field, const Region& region, double step, RecordedMesh& mesh,
                           const Progress& progress) {
  return region.is_patch ? even_mesh(PatchField(field, region.center), step, mesh, progress)
                         : even_mesh(field, step, mesh, progress);
}

std::string rounded_count(double count) {
  return count >= 1e6 ? fmt::format("{:.1f} M", count / 1e6) : fmt::format("{:.0f} k", count / 1e3);
}

std::optional<Vec3d> surface_beside_patch(const ImplicitField& field, const Region& region) {
  constexpr double kNear = 0.02;           // of the body's diagonal
  constexpr double kHalfDiagonal = 0.867;  // of a cube's side: no nearer surface can cross it
  if (!region.is_patch) return {};
  const std::optional<Vec3d> near = down_the_gradient(field, region.center);
  if (!near) return {};
  const double distance = norm(*near - region.center);
  const bool beside =
      distance > kHalfDiagonal * region.size && distance < kNear * norm(field.bounds().extent());
  return beside ? near : std::nullopt;
}

void place_on_ground(const ImplicitField& field, Region& region) {
  if (!region.is_patch) return;
  // The ground within a turned cube has another mean plane, if only a little.
  const int steps = region.aligned ? 3 : 1;
  for (int step = 0; step < steps; ++step) {
    MeshCollector ground;
    mesh_cube(field, region, kLookAround, ground, {}, MeshingDevice::kCpu);
    if (ground.mesh.triangles.empty() && step == 0) return;
    if (ground.mesh.triangles.empty()) break;
    region.plane = mean_plane(ground.mesh);
    if (!region.aligned) return;
    if (!region.plane) {
      throw InputError("aligned: the surface in the cube faces no direction; take a smaller cube");
    }
    region.axes = region.plane->axes;
  }
  region.plane->origin = dot(region.plane->origin, region.axes->up) * region.axes->up;
}

void fail_empty(const Recipe& recipe, const ImplicitField& field, const Region& region, int resolution,
                const std::filesystem::path& file) {
  const int cells = region.is_patch ? kLookAround : std::min(resolution, kLookAround);
  if (const int layer = emptying_layer(recipe, file, cells); layer >= 0) {
    throw InputError(
        fmt::format("{}: layers[{}].{}: nothing of the body is left that a mesh of {} cells shows; make the "
                    "layer's heights smaller{}",
                    file.string(), layer, height_field(recipe.layers[static_cast<std::size_t>(layer)]), cells,
                    region.is_patch ? "" : ", or raise the resolution"));
  }
  if (region.is_patch) {
    const Vec3d p = recipe.origin + nearby_surface_point(field, region.center);
    throw InputError(
        fmt::format("patch: no surface crosses this cube; there is some near {} {} {}", p.x, p.y, p.z));
  }
  if (region.is_cut()) {
    throw InputError(fmt::format("tile: no surface lies in tile {} of {}; take another",
                                 region.tile.index + 1, region.tile.count));
  }
  throw InputError(fmt::format("{}: the whole body lies between the samples of resolution {}; raise it",
                               file.string(), resolution));
}

}  // namespace astrolith
