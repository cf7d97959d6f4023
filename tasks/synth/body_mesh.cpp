#include "tasks/synth/body_mesh.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <span>
#include <utility>

#include "cuda/mesher/gpu_mesher.h"
#include "cuda/mesher/mesh_batch.h"
#include "gravity/vertical_directions.h"
#include "numerics/errors.h"
#include "numerics/interval.h"
#include "synthesis/field/field_mesh.h"
#include "synthesis/mesh/mesh_components.h"

namespace astrolith {
namespace {

namespace fs = std::filesystem;

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
void check_cells(const MeshPart& part) {
  constexpr double kFinestCell = 0x1p-15;  // as a fraction of the body's largest coordinate
  const double finest = kFinestCell * largest_coordinate(part.field.bounds());
  const double cell = part.region.size / part.resolution;
  if (cell >= finest) return;
  throw InputError(
      fmt::format("patch: body.operations: a combined body has cells of {:.3g} at least, these would be "
                  "{:.3g}; lower the resolution or take a larger cube",
                  finest, cell));
}

// Whether a mesh of so many cells shows nothing of the recipe's surface.
bool is_empty(const Recipe& recipe, const fs::path& file, int cells) {
  const ImplicitField field(recipe, file.string());
  if (field.bounds().empty()) return true;
  MeshDiscard sink;
  return mesh_field(field, field.bounds(), cells, sink).triangles == 0;
}

// The layer that takes away what the body and the layers before it have of a surface; -1 where there is none.
int emptying_layer(const Recipe& recipe, const fs::path& file, int cells) {
  Recipe part = recipe;
  if (!is_empty(part, file, cells)) return -1;
  for (std::size_t i = recipe.layers.size(); i > 0; --i) {
    part.layers.resize(i - 1);
    if (!is_empty(part, file, cells)) return static_cast<int>(i) - 1;
  }
  return -1;
}

[[noreturn]] void fail_empty(const MeshPart& part) {
  const auto& [tile, is_patch, center, size, aligned, axes, plane] = part.region;
  const int cells = is_patch ? kLookAround : std::min(part.resolution, kLookAround);
  if (const int layer = emptying_layer(part.recipe, part.file, cells); layer >= 0) {
    throw InputError(fmt::format(
        "{}: layers[{}].{}: nothing of the body is left that a mesh of {} cells shows; make the "
        "layer's heights smaller{}",
        part.file.string(), layer, height_field(part.recipe.layers[static_cast<std::size_t>(layer)]), cells,
        is_patch ? "" : ", or raise the resolution"));
  }
  if (is_patch) {
    const Vec3d p = part.recipe.origin + nearby_surface_point(part.field, center);
    throw InputError(
        fmt::format("patch: no surface crosses this cube; there is some near {} {} {}", p.x, p.y, p.z));
  }
  if (tile.count > 1) {
    throw InputError(
        fmt::format("tile: no surface lies in tile {} of {}; take another", tile.index + 1, tile.count));
  }
  throw InputError(fmt::format("{}: the whole body lies between the samples of resolution {}; raise it",
                               part.file.string(), part.resolution));
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
  TurnedMesh turned(patch.place(), sink);
  MeshSink& to = region.axes ? turned : sink;
  return device == MeshingDevice::kGpu ? mesh_patch_on_gpu(patch, region.size, resolution, to, progress)
                                       : mesh_patch(patch, region.size, resolution, to, progress);
}

// Finds the plane of a patch's map: the mean plane of the surface in its cube. A cube that is to be aligned
// turns to it; the plane then keeps the height of the centroid, and has the middle of the cube in its middle.
void place_on_ground(const ImplicitField& field, Region& region) {
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

bool adds_details(const Layer& layer) {
  const Population* drawn = find_population(layer);
  return (drawn != nullptr && drawn->by_cells) || layer_traits(layer).in_plane;
}

bool is_asked_by_a_mask(const Recipe& recipe, const Layer& layer) {
  const std::string& name = std::visit([](const auto& l) -> const std::string& { return l.name; }, layer);
  return std::any_of(recipe.layers.begin(), recipe.layers.end(), [&](const Layer& other) {
    const LayerMask* mask = find_mask(other);
    return mask != nullptr && mask->layer == name;
  });
}

// The recipe without what is added to its ground; none where nothing is added. All layers keep their places
// in the list and thereby their numbers.
std::optional<Recipe> without_additions(const Recipe& recipe) {
  const bool measured = std::any_of(recipe.layers.begin(), recipe.layers.end(), [](const Layer& layer) {
    return std::holds_alternative<ReliefLayer>(layer);
  });
  Recipe ground = recipe;
  bool added = false;
  for (Layer& layer : ground.layers) {
    if (ReliefLayer* relief = std::get_if<ReliefLayer>(&layer)) {
      added |= relief->finer > 0 || relief->fill_unseen;
      relief->finer = 0;
      relief->fill_unseen = false;
    } else if ((measured || adds_details(layer)) && !is_asked_by_a_mask(recipe, layer)) {
      layer = BoulderLayer{};  // without a boulder
      added = true;
    }
  }
  if (!added) return std::nullopt;
  return ground;
}

// The field of a patch without what is added to its ground; none where nothing is added.
std::optional<ImplicitField> make_ground_field(const MeshPart& part) {
  const std::optional<Recipe> ground = without_additions(part.recipe);
  if (!ground) return std::nullopt;
  return make_region_field(*ground, part.file, part.region);
}

// The point of the surface near the centre of a patch whose cube the surface misses, where there is one
// within a fiftieth of the body.
std::optional<Vec3d> surface_beside_patch(const ImplicitField& field, const Region& region) {
  constexpr double kNear = 0.02;           // of the body's diagonal
  constexpr double kHalfDiagonal = 0.867;  // of a cube's side: no nearer surface can cross it
  const std::optional<Vec3d> near = down_the_gradient(field, region.center);
  if (!near) return {};
  const double distance = norm(*near - region.center);
  const bool beside =
      distance > kHalfDiagonal * region.size && distance < kNear * norm(field.bounds().extent());
  return beside ? near : std::nullopt;
}

// Throws WorkError for a mesh that is not manifold or not closed. A tile or patch may be open where it was
// cut.
void require_closed_manifold(const ManifoldReport& report, const MeshStatistics& statistics) {
  if (report.open_vertices != statistics.cut_vertices || report.late_triangles > 0 ||
      report.non_manifold_vertices > 0) {
    throw WorkError("the mesh is not a closed manifold (" + std::to_string(report.open_vertices) +
                    " open and " + std::to_string(report.non_manifold_vertices) +
                    " non-manifold vertices); nothing was written");
  }
}

// Meshes the part into a sink, without the pieces that are too small.
void mesh_without_crumbs(const MeshPart& part, MeshSink& sink, const StageProgress& progress,
                         BodyMeshReport& result) {
  if (!(part.spec.least_component > 0.0)) {
    result.statistics = mesh_part(part, sink, progress("mesh"));
    return;
  }
  ComponentSizes sizes;
  mesh_part(part, sizes, progress("pieces"));
  ComponentChoice choice = sizes.larger_than(part.spec.least_component);
  result.dropped_components = choice.dropped_components;
  ComponentFilter filter(std::move(choice), sink);
  result.statistics = mesh_part(part, filter, progress("mesh"));
  filter.finish();
}

}  // namespace

Region make_region(const MeshSpec& spec) {
  Region region;
  if (!spec.patch.empty()) {
    region.is_patch = true;
    region.center = {spec.patch[0], spec.patch[1], spec.patch[2]};
    region.size = spec.patch[3];
    region.aligned = spec.aligned;
    if (!(region.size >= kMinPositive) || !(region.size <= kMaxNumber) ||
        !(squared_norm(region.center) <= kMaxNumber * kMaxNumber)) {
      throw InputError(
          "patch: has no centre or no side above 0; write X Y Z SIDE in the recipe's length unit");
    }
  } else if (!spec.tile.empty()) {
    int number = 0, count = 0;
    char rest = 0;
    if (std::sscanf(spec.tile.c_str(), "%6d/%6d%c", &number, &count, &rest) != 2) {
      throw InputError("tile: \"" + spec.tile + "\" is no tile; write I/N with I from 1 to N, such as 3/16");
    }
    if (number < 1 || number > count) {
      throw InputError(
          fmt::format("tile: {}/{} is no tile; write I/N with I from 1 to N, such as 3/16", number, count));
    }
    region.tile = {number - 1, count};
  }
  return region;
}

MeshPart MeshPart::with_cells(int cells) const {
  MeshPart part = *this;
  part.resolution = cells;
  if (part.device == MeshingDevice::kGpu && !lacking_on_gpu(part).empty()) part.device = MeshingDevice::kCpu;
  return part;
}

void require_body(const Recipe& recipe, const fs::path& file) {
  if (recipe.body) return;
  throw InputError(file.string() +
                   ": body: absent; lay its layers on a body with --base BODY.json, or draw its height map "
                   "with --texture WxH");
}

ImplicitField make_region_field(const Recipe& recipe, const fs::path& file, const Region& region,
                                const Progress& progress, const ImplicitField* like) {
  ImplicitField field(recipe, file.string(), region.cube(), progress, like);
  if (field.bounds().empty()) {
    throw InputError(file.string() + ": body.iso_value: no point of the body reaches it; lower it");
  }
  return field;
}

MeshPart make_body_part(const MeshSpec& spec, const Recipe& recipe, const fs::path& file, bool needs_plane,
                        const Progress& progress, const std::function<void(const std::string&)>& say) {
  constexpr int kMostMoves = 3;  // fine layers are known near a patch alone
  Region asked = make_region(spec);
  if (asked.is_patch) asked.center = asked.center - recipe.origin;
  MeshPart part{spec, recipe, file, asked, make_region_field(recipe, file, asked, progress), spec.resolution};
  if (!asked.is_patch) return part;
  Region& region = part.region;
  for (int move = 0; move < kMostMoves; ++move) {
    std::optional<Vec3d> beside = surface_beside_patch(part.field, region);
    if (!beside) break;
    if (const auto ground = make_ground_field(part))
      beside = surface_beside_patch(*ground, region).value_or(*beside);
    say(fmt::format(
        "patch: no surface crosses this cube; moved by {:.4g} {} to {:.9g} {:.9g} {:.9g} on the surface",
        norm(*beside - region.center), recipe.length_unit, recipe.origin.x + beside->x,
        recipe.origin.y + beside->y, recipe.origin.z + beside->z));
    region.center = *beside;
    part.field = make_region_field(recipe, file, region, progress, &part.field);
  }
  if (!needs_plane && !region.aligned) return part;
  if (const std::optional<ImplicitField> ground = make_ground_field(part)) place_on_ground(*ground, region);
  if (!region.plane) place_on_ground(part.field, region);
  return part;
}

std::string lacking_on_gpu(const MeshPart& part) {
  const Region& region = part.region;
  if (region.is_patch) {
    const PatchPlace place(region.center, region.axes);
    return obstacle_on_gpu(part.field.patch_tables(),
                           block_side(patch_grid(place, region.size, part.resolution)));
  }
  return obstacle_on_gpu(part.field.tables(), block_side(field_grid(part.field.bounds(), part.resolution)));
}

MeshStatistics mesh_part(const MeshPart& part, MeshSink& sink, const Progress& progress) {
  const auto& [spec, recipe, file, region, field, resolution, device, may_be_empty] = part;
  if (region.is_patch && !field.has_local_form()) check_cells(part);
  if (region.is_patch) return mesh_cube(field, region, resolution, sink, progress, device);
  return device == MeshingDevice::kGpu
             ? mesh_field_on_gpu(field, field.bounds(), resolution, sink, progress, region.tile)
             : mesh_field(field, field.bounds(), resolution, sink, progress, region.tile);
}

BodyMeshReport make_body_mesh(const MeshPart& part, MeshSink& sink, const StageProgress& progress) {
  ManifoldCheck check;
  SinkList sinks;
  sinks.add(check);
  sinks.add(sink);
  BodyMeshReport result;
  RecordedMesh recorded;
  mesh_without_crumbs(part, part.spec.even ? static_cast<MeshSink&>(recorded) : sinks, progress, result);
  if (part.spec.even) {
    const double step = result.statistics.step;
    const Progress evening = progress("even");
    result.even = part.region.is_patch
                      ? even_mesh(PatchField(part.field, part.region.center), step, recorded, evening)
                      : even_mesh(part.field, step, recorded, evening);
    result.statistics.evaluations += result.even->evaluations;
    recorded.replay(sinks);  // in the same batches
  }
  result.manifold = check.finish();
  if (result.manifold.triangles > 0) {
    require_closed_manifold(result.manifold, result.statistics);
  } else if (!part.may_be_empty) {
    fail_empty(part);
  }
  return result;
}

ErosionStatistics erode_body(const Erosion& erosion, TriangleMesh& mesh, const Progress& progress) {
  const std::vector<Vec3d> up = vertical_directions(mesh, {erosion.density, erosion.rotation_period});
  return erode(mesh, up, erosion.talus_angle, erosion.iterations, progress);
}

}  // namespace astrolith
