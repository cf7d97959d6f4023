#include "tasks/synth/mesh_job.h"

#include <fmt/format.h>

#include <cstdio>
#include <new>
#include <optional>
#include <utility>

#include "numerics/errors.h"
#include "numerics/files/output_file.h"
#include "numerics/files/sha256.h"
#include "numerics/length_unit.h"
#include "numerics/memory_use.h"
#include "numerics/vec3_json.h"
#include "synthesis/field/feature_list.h"
#include "tasks/job/output_names.h"
#include "tasks/job/words.h"
#include "tasks/synth/bake.h"
#include "tasks/synth/body_mesh.h"
#include "tasks/synth/detail_levels.h"
#include "tasks/synth/erode_body.h"
#include "tasks/synth/ground_maps.h"
#include "tasks/synth/mesh_job_internal.h"
#include "tasks/synth/mesh_output.h"
#include "tasks/synth/patch_ground.h"
#include "tasks/synth/surface_gravity.h"

namespace astrolith {
namespace {

namespace fs = std::filesystem;

Region parse_tile(const std::string& text) {
  int number = 0, count = 0;
  char rest = 0;
  if (std::sscanf(text.c_str(), "%6d/%6d%c", &number, &count, &rest) != 2) {
    throw InputError("tile: \"" + text + "\" is no tile; write I/N with I from 1 to N, such as 3/16");
  }
  return tile_region(number, count);
}

// The region that the options name.
Region region_of(const MeshRequest& request) {
  const std::vector<double>& patch = request.patch;
  if (!patch.empty()) {
    Region region = patch_region({patch[0], patch[1], patch[2]}, patch[3]);
    region.aligned = request.aligned;
    return region;
  }
  return request.tile.empty() ? Region{} : parse_tile(request.tile);
}

void check_request(const MeshRequest& request, const Region& region, const Recipe& recipe,
                   const fs::path& file) {
  if (recipe.erosion && (region.is_cut() || request.points)) {
    throw InputError(file.string() + ": erosion: is of the whole mesh; leave out " +
                     (region.is_patch   ? "--patch"
                      : region.is_cut() ? "--tile"
                                        : "--points") +
                     ", or take erosion out of the recipe");
  }
  if (recipe.erosion && request.levels > 1) {
    throw InputError(file.string() +
                     ": erosion: is of one mesh; leave out --lod, or take erosion out of the recipe");
  }
  if (recipe.erosion && request.labels) {
    throw InputError(file.string() +
                     ": erosion: moves what layers made; leave out --labels, or take erosion out of the "
                     "recipe");
  }
  if (request.gravity.wanted() && (region.tile.count > 1 || request.points || request.labels)) {
    throw InputError("--gravity: is of the whole body or a patch; leave out --tile, --points and --labels");
  }
  check_bake(request, recipe, file, region.is_cut());
  check_gravity(request.gravity, recipe);
  if (request.least_component > 0.0 && region.is_cut()) {
    throw InputError(
        "--min-component: the size of a piece that is cut is not known; leave out --tile and "
        "--patch");
  }
}

}  // namespace

void check_mesh_request(const MeshRequest& request, const Recipe& recipe, const fs::path& file) {
  check_request(request, region_of(request), recipe, file);
}

void check_mesh_name(const MeshRequest& request, const fs::path& output) {
  const MeshFormat& format = written_mesh_format(output);
  if (request.points || request.labels || request.gravity.wanted())
    require_mesh_format(output, &MeshFormat::has_values);
  if (!request.uv.empty()) require_mesh_format(output, &MeshFormat::has_texture_coordinates);
  if ((request.even || request.levels > 1) && format.counts != nullptr) {
    throw InputError(output.string() +
                     ": has facets of its own; leave out --even and --lod, or write a .ply");
  }
}

void check_mesh_outputs(const Job& job, const MeshRequest& request, const fs::path& output) {
  if (!output.empty()) {
    check_mesh_name(request, output);
    for (const fs::path& file : level_files(output, request.levels)) require_writable(file);
    for (const fs::path& file : map_files(request, output)) require_writable(file);
  }
  check_preview(job, request.preview);
  for (const fs::path& map : {request.height_map, request.hazard.file}) {
    if (!map.empty()) require_extension(map, {".tif"});
  }
  if (request.landforms.empty()) return;
  require_extension(request.landforms, {".csv", ".json"});
  require_writable(request.landforms);
}

namespace {

void summarize_mesh(Job& job, const Recipe& recipe, const Region& region, const MeshStatistics& statistics,
                    const ManifoldReport& report) {
  job.summary["vertices"] = report.vertices;
  job.summary["triangles"] = report.triangles;
  job.summary["closed"] = report.closed();
  job.summary["manifold"] = report.manifold() || report.triangles == 0;
  if (!region.is_cut()) job.summary["genus"] = report.genus;
  job.summary["components"] = report.components;
  job.summary["evaluations"] = statistics.evaluations;
  job.summary["cell"] = statistics.step;
  job.summary["active_blocks"] = statistics.active_blocks;
  job.summary["total_blocks"] = statistics.total_blocks;
  if (region.is_patch || !(recipe.origin == Vec3d{})) {
    job.summary["origin"] = json_of(recipe.origin + region.center);
  }
  if (!region.axes) return;
  job.summary["patch_axes"] = {{"right", json_of(region.axes->right)},
                               {"ahead", json_of(region.axes->ahead)},
                               {"up", json_of(region.axes->up)}};
}

// A tile of a .ply may hold no triangle, so that the tiles of a body can be made one after the other.
bool may_be_empty(const MeshRequest& request, const Region& region, const fs::path& output) {
  return region.tile.count > 1 && written_mesh_format(output).streamed && request.preview.file.empty();
}

std::string describe_mesh(const ManifoldReport& report, const MeshRequest& request) {
  const std::string triangles = request.points
                                    ? std::to_string(report.vertices) + " points of a mesh that is "
                                    : std::to_string(report.triangles) + " triangles, ";
  if (!report.closed()) {
    return triangles + (request.patch.empty() ? "tile " + request.tile : "a patch") +
           ", open where cut, manifold";
  }
  // Rough noise leaves small separate pieces, which few people want.
  const bool crumbs = report.components > 1 && !(request.least_component > 0.0);
  return triangles + "closed, manifold, genus " + std::to_string(report.genus) + ", " +
         counted(static_cast<std::size_t>(report.components), "component") +
         (crumbs ? " (--min-component 1e-3 leaves out small ones)" : "");
}

// Programs take lengths of a file that states no unit for kilometres.
void say_unstated_unit(const Job& job, const std::string& unit, const fs::path& output) {
  if (unit == "km" || !has_known_length(unit) || written_mesh_format(output).tells_unit) return;
  job.say(fmt::format("note: a {} states no unit; read it with --unit {}", mesh_extension(output), unit));
}

// Heights near the radius tear a body into pieces, which no seed or resolution mends.
void question_pieces(const Job& job, const ImplicitField& field, const Recipe& recipe, std::int64_t pieces) {
  constexpr std::int64_t kTorn = 10;
  const Vec3d e = field.bounds().extent();
  const double height = field.height_bound(), thickness = std::min({e.x, e.y, e.z});
  if (pieces < kTorn || height < 0.25 * thickness) return;
  job.say(fmt::format(
      "note: {} pieces: the layers are up to {:.3g} {} high on a body that is {:.3g} thick with them; lower "
      "their heights",
      pieces, height, recipe.length_unit, thickness));
}

// A mesh to be made: what was asked for, and what was found out about it.
struct MeshPlan {
  const MeshRequest& request;
  const Recipe& recipe;
  const fs::path& file;  // of the recipe
  const Region& region;
  const ImplicitField& field;
  int resolution;
  const fs::path& output;
};

// Writes the mesh that a job has made, and coarser levels of it where they were asked for.
void write_levels_of(Job& job, const MeshPlan& plan, const BodyMeshJob& made_by, MeshOutput& result,
                     const std::vector<VertexValues>& quantities) {
  std::vector<DetailLevel> coarser = coarser_levels(job, made_by, plan.request.levels, result.collected());
  for (DetailLevel& level : coarser) result.paint(level.mesh);
  std::vector<MeshLevel> levels{{&result.collected()}};
  for (const DetailLevel& level : coarser) levels.push_back({&level.mesh});
  if (plan.request.has_charts()) {
    add_skins(job, plan.request, {made_by, result.colors(), plan.output}, levels);
    result.set_skin(levels.front().skin);
  }
  if (coarser.empty() || level_file(plan.output, 1) != plan.output) result.write(quantities);
  if (coarser.empty()) return;
  write_levels(job, plan.output, plan.resolution, coarser, levels, result.info());
}

// Makes the mesh and all files that were asked for.
void make_files(Job& job, const MeshPlan& plan, const ChosenDevice& chosen) {
  const auto& [request, recipe, file, region, field, resolution, output] = plan;
  MeshOutput result(job.tool(), request, recipe, file, region, field, output);
  ExtentOfMesh extent;
  SinkList sinks;
  sinks.add(result.sink());
  sinks.add(extent);
  std::optional<TileRecord> tile;
  if (!request.tile.empty() && !request.points)
    sinks.add(tile.emplace(field, resolution, region.tile).sink());
  const BodyMeshJob made_by{recipe,
                            field,
                            file,
                            region,
                            resolution,
                            request.least_component,
                            chosen ? MeshingDevice::kGpu : MeshingDevice::kCpu,
                            may_be_empty(request, region, output),
                            request.even};
  const BodyMeshReport made = make_body_mesh(made_by, sinks, job.stages());
  ManifoldReport report = made.manifold;
  if (tile) tile->finish(report.open_vertices);
  if (request.least_component > 0.0) job.summary["dropped_components"] = made.dropped_components;
  if (made.even && report.triangles > 0) report_even(job, *made.even, recipe.length_unit);
  if (recipe.erosion) {
    TriangleMesh& mesh = result.collected();
    const ErosionStatistics done = erode_body(*recipe.erosion, mesh, job.progress("erosion"));
    report_erosion(job, *recipe.erosion, done, mesh.vertices.size());
    extent.measure(result.collected());
  }

  require_cameras_outside(job, request.preview, result.collected());
  result.paint();
  std::optional<SurfaceGravity> gravity;
  std::vector<VertexValues> quantities;
  if (request.gravity.wanted()) {
    const TriangleMesh& mesh = result.collected();
    const BodyOfPatch body = region.is_patch ? body_of_patch(job, recipe, file) : BodyOfPatch{};
    gravity.emplace(job, request.gravity, recipe, region.is_patch ? body.mesh : mesh);
    quantities = gravity->at_vertices(job, mesh, region.center, region.is_patch ? body.coarse : mesh);
  }
  write_levels_of(job, plan, made_by, result, quantities);
  say_unstated_unit(job, recipe.length_unit, output);
  const MeshFormat& format = written_mesh_format(output);
  if (format.counts != nullptr) {
    const MeshCounts kept = format.counts({report.vertices, report.triangles});
    report.vertices = kept.vertices, report.triangles = kept.triangles;
  }
  if (!request.preview.file.empty())
    write_preview(job, request.preview, result.collected(), recipe.length_unit);
  if (!request.preview.maps.empty())
    write_preview_maps(job, request.preview, result.collected(),
                       {recipe, file, region, field, made.statistics.step});
  if (request.has_maps()) {
    const PatchGround ground{recipe, region, field};
    const HeightMap map = heights_of_patch(result.collected(), ground, resolution);
    if (!request.height_map.empty()) write_height_map(job, request.height_map, map, ground);
    if (gravity && !request.hazard.file.empty()) write_hazard_map(job, request.hazard, map, ground, *gravity);
  }
  if (!request.landforms.empty())
    write_feature_list(field, recipe, region.cube(), made.statistics.step, request.landforms);
  summarize_mesh(job, recipe, region, made.statistics, report);
  if (!region.is_cut()) question_pieces(job, field, recipe, report.components);
  if (has_colors(recipe)) {
    job.summary["vertex_colors"] = format.has_colors;
    if (!format.has_colors && request.bake == 0) {
      job.say("note: " + output.extension().string() +
              " holds no colours, which the recipe's layers have; write a .ply or a .glb");
    }
  }
  summarize_output(job, output);
  if (tile) tile->add_to_summary(job, recipe, output);
  if (report.triangles == 0) return job.say(output.string() + ": no surface lies in tile " + request.tile);
  job.say(output.string() + ": " + describe_mesh(report, request) + ", " +
          size_words(extent.box.extent(), recipe.length_unit) + chosen.remark());
}

}  // namespace

void declare_mesh_options(Job& job, MeshRequest& request) {
  declare_size_options(job, request.size);
  Option tile =
      job.options
          .add_option(
              "--tile", request.tile,
              "only tile I of N, slabs along z that many machines can make: open where cut, with the same "
              "vertices there as the next tile, so that all join without cracks; --summary then has a "
              "certificate for check_tiles")
          .placeholder("I/N");
  job.options
      .add_option(
          "--patch", request.patch,
          "only what a cube holds of the surface, given by its centre and its side; --resolution then "
          "counts cells along that side. Its vertices are relative to the centre, which the file states "
          "as its origin")
      .expected(4)
      .excludes(tile)
      .placeholder("X Y Z SIDE");
  job.options
      .add_flag(
          "--aligned", request.aligned,
          "the cube of --patch stands on its ground: it is turned so that one axis is the mean normal of "
          "the surface in it. A --height-map then has the cube's square and no empty border; vertices "
          "still lie along the recipe's axes")
      .needs(job.options.option("--patch"));
  job.options
      .add_option(
          "--min-component", request.least_component,
          "leave out pieces and cavities of less volume than this share of the largest piece's; the mesh is "
          "then made twice")
      .check(in_range(0.0, 1.0))
      .default_text("0, all stay");
  job.options.add_flag(
      "--even", request.even,
      "make the triangles more even: vertices move along the surface by about a quarter of a cell, and back "
      "onto it, but for those at the cuts of tiles and patches. Keeps the mesh in memory, about 75 bytes for "
      "each triangle");
  job.options
      .add_option("--lod", request.levels,
                  "levels of detail: so many meshes, each of a quarter of the triangles of the one before. A "
                  ".glb holds all of them (MSFT_lod); of other formats they are files: rock.ply, "
                  "rock_lod1.ply. The summary says how far each one lies from the finest")
      .check(in_range(1, 10))
      .placeholder("N");
  job.options
      .add_option(
          "--height-map", request.height_map,
          "also the patch as a GeoTIFF of metres over its mean plane, and its frame beside it as JSON")
      .placeholder("FILE.tif")
      .writes(height_map_files);
  job.options.add_flag("--points", request.points,
                       "only the mesh's vertices with their outward unit normals, as an oriented point cloud "
                       "(.ply without faces)");
  job.options.add_flag(
      "--labels", request.labels,
      "with each vertex the layer that changed the surface most there (0 = the bare body, 1 = "
      "the recipe's first layer; the file's header says which is which) and the height of "
      "all layers (.ply)");
  declare_bake_options(job, request);
  request.device.add_to(job.options);
  declare_preview_options(job, request.preview);
  job.options
      .add_option(
          "--gravity", request.gravity.density_and_period,
          "with each vertex potential, acceleration, slope and elevation for this density and this period of "
          "rotation about z, 0 = at rest (.ply); of a patch, for the mass of the whole body")
      .expected(2)
      .placeholder("KG_M3 HOURS");
  job.options
      .add_option(
          "--hazard-map", request.hazard.file,
          "also a GeoTIFF with the pixels of --height-map that says of the ground that a lander stands "
          "on, about each pixel, its slope in degrees, its roughness in metres, and the diameter of the "
          "largest boulder in it")
      .placeholder("FILE.tif")
      .needs(job.options.option("--patch"))
      .needs(job.options.option("--gravity"))
      .writes();
  job.options
      .add_option("--footprint", request.hazard.footprint,
                  "of --hazard-map: the side of the square of ground that a lander stands on")
      .placeholder("L")
      .needs(job.options.option("--hazard-map"))
      .default_text("");
  job.options
      .add_option("--feature-list", request.landforms,
                  "also a list of the craters and boulders, those of the recipe and those drawn: places, "
                  "sizes, ages and angles (degrees), in the recipe's unit")
      .placeholder("FILE.csv|FILE.json")
      .writes();
  for (const char* of_one : {"--tile", "--patch", "--points", "--labels", "--gravity"}) {
    job.options.option("--lod").excludes(job.options.option(of_one));
  }
}

namespace {

struct FieldRegion {
  Region region;
  ImplicitField field;
};

// The field of a region; a patch beside the surface is moved onto it. Its plane is found where it is needed.
FieldRegion region_on_surface(Job& job, const Recipe& recipe, const fs::path& file, Region region,
                              bool needs_plane) {
  constexpr int kMostMoves = 3;  // fine layers are known near a patch alone
  for (int move = 0;; ++move) {
    ImplicitField field = field_of_region(recipe, file, region, job.progress("landforms"));
    std::optional<Vec3d> beside = move < kMostMoves ? surface_beside_patch(field, region) : std::nullopt;
    if (!beside) {
      if (needs_plane) place_patch(recipe, file, field, region);
      return {region, std::move(field)};
    }
    if (const auto ground = field_of_ground(recipe, file, region))
      beside = surface_beside_patch(*ground, region).value_or(*beside);
    job.say(fmt::format(
        "patch: no surface crosses this cube; moved by {:.4g} {} to {:.9g} {:.9g} {:.9g} on the surface",
        norm(*beside - region.center), recipe.length_unit, recipe.origin.x + beside->x,
        recipe.origin.y + beside->y, recipe.origin.z + beside->z));
    region.center = *beside;
  }
}

// Meshes that are made to be counted are made by the device that makes the mesh.
int choose_resolution(Job& job, const MeshRequest& request, PlannedMesh planned) {
  if (request.device.has_gpu()) {
    planned.device = MeshingDevice::kGpu;
    try {
      return choose_resolution(job, request.size, planned);
    } catch (const DeviceError& error) {
      request.device.after_failure(job, error);
      planned.device = MeshingDevice::kCpu;
    }
  }
  return choose_resolution(job, request.size, planned);
}

// Makes the files within the memory of --max-memory, on a GPU, too.
void make_files_in_memory(Job& job, const MeshPlan& plan, const ChosenDevice& chosen) {
  const MeshSizeRequest& size = plan.request.size;
  if (!(size.max_memory_gb > 0.0)) return make_files(job, plan, chosen);
  try {
    const MemoryGuard guard(memory_limit(size.max_memory_gb));
    make_files(job, plan, chosen);
  } catch (const std::bad_alloc&) {
    fail_memory(job, size, plan.output);
  }
}

}  // namespace

void make_mesh(Job& job, const MeshRequest& request, const Recipe& recipe, const fs::path& file,
               const fs::path& output) {
  Region asked = region_of(request);
  check_request(request, asked, recipe, file);
  if (asked.is_patch) asked.center = asked.center - recipe.origin;
  const auto [region, field] =
      region_on_surface(job, recipe, file, asked, asked.aligned || request.has_maps());
  const MeshUse use{!request.preview.file.empty() || request.has_maps() || request.levels > 1,
                    recipe.erosion.has_value(),
                    request.least_component > 0.0,
                    request.gravity.wanted(),
                    request.labels,
                    !request.uv.empty(),
                    request.even,
                    request.bake};
  const int resolution = choose_resolution(job, request, {field, recipe, region, output, use});
  check_height_map(request.height_map, region, recipe, resolution);
  check_levels(request.levels, resolution);
  check_hazard_map(request.hazard, region, recipe, resolution);
  report_layers_left_out(job, field, recipe, file, region.is_patch);
  if (request.size.only_predict) return;
  if (!region.is_cut()) require_cameras_outside(job, request.preview, field);
  ChosenDevice chosen = request.device.choose(job, lacking_on_gpu(field, region, resolution));
  const MeshPlan plan{request, recipe, file, region, field, resolution, output};
  if (chosen) {
    try {
      return make_files_in_memory(job, plan, chosen);
    } catch (const DeviceError& error) {
      chosen = request.device.after_failure(job, error);
    }
  }
  make_files_in_memory(job, plan, chosen);
}

void summarize_output(Job& job, const fs::path& output) {
  job.summary["peak_bytes"] = peak_bytes();
  job.summary["sha256"] = sha256_of_file(output);
}

}  // namespace astrolith
