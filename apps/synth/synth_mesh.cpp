#include "apps/synth/synth_mesh.h"

#include <fmt/format.h>

#include <algorithm>
#include <memory>
#include <new>
#include <optional>
#include <utility>

#include "apps/synth/synth_erosion.h"
#include "apps/synth/synth_even.h"
#include "apps/synth/synth_height_map.h"
#include "apps/synth/synth_left_out.h"
#include "apps/synth/synth_preview_maps.h"
#include "apps/synth/synth_region.h"
#include "apps/synth/synth_sinks.h"
#include "apps/synth/synth_tile.h"
#include "geometry/io/mesh_io.h"
#include "geometry/io/ply_stream_writer.h"
#include "numerics/errors.h"
#include "numerics/files/output_file.h"
#include "numerics/files/sha256.h"
#include "numerics/length_unit.h"
#include "numerics/memory_use.h"
#include "numerics/vec3_json.h"
#include "synthesis/field/landform_list.h"
#include "synthesis/field/surface_colors.h"
#include "synthesis/field/surface_labels.h"
#include "tasks/job/output_names.h"
#include "tasks/job/words.h"
#include "tasks/synthesis/body_mesh.h"

namespace astrolith {
namespace {

namespace fs = std::filesystem;

void check_request(const MeshRequest& request, const Region& region, const Recipe& recipe,
                   const fs::path& file) {
  if (recipe.erosion && (region.is_cut() || request.points)) {
    throw InputError(file.string() + ": erosion: is of the whole mesh; leave out " +
                     (region.is_patch   ? "--patch"
                      : region.is_cut() ? "--tile"
                                        : "--points") +
                     ", or take erosion out of the recipe");
  }
  if (recipe.erosion && request.labels) {
    throw InputError(file.string() +
                     ": erosion: moves what layers made; leave out --labels, or take erosion out of the "
                     "recipe");
  }
  if (request.gravity.wanted() && (region.is_cut() || request.points || request.labels)) {
    throw InputError("--gravity: is of the whole mesh; leave out --tile, --patch, --points and --labels");
  }
  check_gravity(request.gravity, recipe);
  if (request.least_component > 0.0 && region.is_cut()) {
    throw InputError(
        "--min-component: the size of a piece that is cut is not known; leave out --tile and "
        "--patch");
  }
}

}  // namespace

void check_mesh_request(const MeshRequest& request, const Recipe& recipe, const fs::path& file) {
  check_request(request, parse_region(request.tile, request.patch, request.aligned), recipe, file);
}

void check_mesh_name(const MeshRequest& request, const fs::path& output) {
  check_mesh_extension(output);
  if (request.points || request.labels || request.gravity.wanted()) {
    require_extension(output, {".ply", ".ply.zst"});
  }
  if (request.texture_coordinates) require_extension(output, {".glb"});
  if (request.even && output.extension() == ".icq") {
    throw InputError(output.string() +
                     ": has quadrilaterals of its own, which lie evenly; leave out --even, or write a .ply");
  }
}

void check_mesh_outputs(const Program& program, const MeshRequest& request, const fs::path& output) {
  if (!output.empty()) {
    check_mesh_name(request, output);
    require_writable(output);
  }
  check_preview(program, request.preview);
  if (!request.height_map.empty()) require_extension(request.height_map, {".tif"});
  if (request.landforms.empty()) return;
  require_extension(request.landforms, {".csv", ".json"});
  require_writable(request.landforms);
}

namespace {

void summarize_mesh(Program& program, const Region& region, const MeshStatistics& statistics,
                    const ManifoldReport& report) {
  program.summary["vertices"] = report.vertices;
  program.summary["triangles"] = report.triangles;
  program.summary["closed"] = report.closed();
  program.summary["manifold"] = report.manifold() || report.triangles == 0;
  if (!region.is_cut()) program.summary["genus"] = report.genus;
  program.summary["components"] = report.components;
  program.summary["evaluations"] = statistics.evaluations;
  program.summary["cell"] = statistics.step;
  program.summary["active_blocks"] = statistics.active_blocks;
  program.summary["total_blocks"] = statistics.total_blocks;
  if (region.is_patch) program.summary["origin"] = json_of(region.center);
  if (!region.axes) return;
  program.summary["patch_axes"] = {{"right", json_of(region.axes->right)},
                                   {"ahead", json_of(region.axes->ahead)},
                                   {"up", json_of(region.axes->up)}};
}

// A tile of a .ply may hold no triangle, so that the tiles of a body can be made one after the other.
bool may_be_empty(const MeshRequest& request, const Region& region, const fs::path& output) {
  return region.tile.count > 1 && is_ply_name(output) && request.preview.file.empty();
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
void say_unstated_unit(const Program& program, const std::string& unit, const fs::path& output) {
  if (unit == "km" || !has_known_length(unit) || written_mesh_format(output).tells_unit) return;
  program.say(fmt::format("note: a {} states no unit; read it with --unit {}", mesh_extension(output), unit));
}

// Whether the format has a place for the colours of vertices.
bool holds_colors(const fs::path& output) { return is_ply_name(output) || output.extension() == ".glb"; }

// Receives a mesh while it is made, and writes its file. A PLY file is written as the mesh grows, unless
// erosion changes the finished mesh. The other formats, erosion and the picture need the whole mesh in
// memory.
class MeshOutput {
 public:
  MeshOutput(const std::string& tool, const MeshRequest& request, const Recipe& recipe, const fs::path& file,
             const Region& region, const ImplicitField& field, const fs::path& output)
      : output_(output),
        center_(region.center),
        info_{recipe.length_unit, recipe.frame, "made by " + tool, {}} {
    if (region.is_patch) info_.origin = region.center;
    info_.texture_coordinates = request.texture_coordinates;
    if (has_colors(recipe) && (holds_colors(output) || !request.preview.file.empty())) {
      colors_.emplace(recipe, file.string(), field);
    }
    if (request.labels) {
      labels_.emplace(recipe, field, region.cube());
      info_.notes = labels_->legend();
    }
    const bool streamed = is_ply_name(output) && !recipe.erosion && !request.gravity.wanted();
    if (!streamed || !request.preview.file.empty() || !request.height_map.empty()) sinks_.add(collector_);
    if (streamed) stream(request.points);
  }
  MeshOutput(const MeshOutput&) = delete;
  MeshOutput& operator=(const MeshOutput&) = delete;

  MeshSink& sink() { return sinks_; }
  // The mesh in memory; empty where nothing needs it there.
  TriangleMesh& collected() { return collector_.mesh; }

  // Paints the mesh in memory. Call it when the mesh is complete.
  void paint() {
    if (colors_) collector_.mesh.colors = colors_->colors_of(center_, collector_.mesh);
  }

  // Completes the file. Before that it does not exist. Quantities, if any, are properties of its vertices.
  void write(const std::vector<VertexValues>& quantities) {
    if (writer_) {
      writer_->finish();
    } else if (!quantities.empty()) {
      write_ply_values(collector_.mesh, quantities, output_, info_);
    } else {
      write_mesh(collector_.mesh, output_, info_);
    }
  }

 private:
  void stream(bool only_points) {
    VertexLabeller labeller;
    VertexPainter painter;
    if (labels_) labeller = [this](auto vertices, auto out) { labels_->label(center_, vertices, out); };
    if (colors_) painter = [this](auto vertices, auto out) { colors_->paint(center_, vertices, out); };
    writer_ = std::make_unique<PlyStreamWriter>(output_, info_, std::move(labeller), std::move(painter));
    points_ = std::make_unique<PointsOnly>(*writer_);
    sinks_.add(only_points ? static_cast<MeshSink&>(*points_) : *writer_);
  }

  fs::path output_;
  Vec3d center_;  // of the patch; 0 for a whole mesh
  MeshFileInfo info_;
  std::optional<SurfaceColors> colors_;  // absent where nothing shows them
  std::optional<SurfaceLabels> labels_;
  MeshCollector collector_;
  std::unique_ptr<PlyStreamWriter> writer_;
  std::unique_ptr<PointsOnly> points_;
  SinkList sinks_;
};

// A mesh to be made: what was asked for, and what was found out about it.
struct MeshJob {
  const MeshRequest& request;
  const Recipe& recipe;
  const fs::path& file;  // of the recipe
  const Region& region;
  const ImplicitField& field;
  int resolution;
  const fs::path& output;
};

// Makes the mesh and all files that were asked for.
void make_files(Program& program, const MeshJob& job, const ChosenDevice& chosen) {
  const auto& [request, recipe, file, region, field, resolution, output] = job;
  MeshOutput result(program.tool(), request, recipe, file, region, field, output);
  ExtentOfMesh extent;
  SinkList sinks;
  sinks.add(result.sink());
  sinks.add(extent);
  std::optional<TileRecord> tile;
  if (!request.tile.empty() && !request.points)
    sinks.add(tile.emplace(field, resolution, region.tile).sink());
  const BodyMeshReport made =
      make_body_mesh({recipe, field, file, region, resolution, request.least_component,
                      chosen ? MeshingDevice::kGpu : MeshingDevice::kCpu,
                      may_be_empty(request, region, output), request.even},
                     sinks, [&](const std::string& stage) { return program.progress(stage); });
  ManifoldReport report = made.manifold;
  if (tile) tile->finish(report.open_vertices);
  if (request.least_component > 0.0) program.summary["dropped_components"] = made.dropped_components;
  if (made.even && report.triangles > 0) report_even(program, *made.even, recipe.length_unit);
  if (recipe.erosion) {
    erode_mesh(program, *recipe.erosion, result.collected());
    extent.measure(result.collected());
  }

  require_cameras_outside(program, request.preview, result.collected());
  result.paint();
  std::vector<VertexValues> quantities;
  if (request.gravity.wanted())
    quantities = vertex_gravity(program, request.gravity, recipe, result.collected());
  result.write(quantities);
  say_unstated_unit(program, recipe.length_unit, output);
  const MeshCounts kept = counts_in_file({report.vertices, report.triangles}, output);
  report.vertices = kept.vertices, report.triangles = kept.triangles;
  if (!request.preview.file.empty())
    write_preview(program, request.preview, result.collected(), recipe.length_unit);
  if (!request.preview.maps.empty())
    write_preview_maps(program, request.preview, result.collected(),
                       {recipe, file, region, field, made.statistics.step});
  if (!request.height_map.empty())
    write_height_map(program, request.height_map, result.collected(), region, recipe, resolution);
  if (!request.landforms.empty())
    write_landform_list(field, recipe, region.cube(), made.statistics.step, request.landforms);
  summarize_mesh(program, region, made.statistics, report);
  if (has_colors(recipe)) {
    program.summary["vertex_colors"] = holds_colors(output);
    if (!holds_colors(output)) {
      program.say("note: " + output.extension().string() +
                  " holds no colours, which the recipe's layers have; write a .ply or a .glb");
    }
  }
  summarize_output(program, output);
  if (tile) tile->add_to_summary(program, recipe, output);
  if (report.triangles == 0)
    return program.say(output.string() + ": no surface lies in tile " + request.tile);
  program.say(output.string() + ": " + describe_mesh(report, request) + ", " +
              size_words(extent.box.extent(), recipe.length_unit) + chosen.remark());
}

}  // namespace

void declare_mesh_options(Program& program, MeshRequest& request) {
  declare_size_options(program, request.size);
  Option tile =
      program.app
          .add_option(
              "--tile", request.tile,
              "only tile I of N, slabs along z that many machines can make: open where cut, with the same "
              "vertices there as the next tile, so that all join without cracks; --summary then has a "
              "certificate for check_tiles")
          .placeholder("I/N");
  program.app
      .add_option(
          "--patch", request.patch,
          "only what a cube holds of the surface, given by its centre and its side; --resolution then "
          "counts cells along that side. Its vertices are relative to the centre, which the file states "
          "as its origin")
      .expected(4)
      .excludes(tile)
      .placeholder("X Y Z SIDE");
  program.app
      .add_flag(
          "--aligned", request.aligned,
          "the cube of --patch stands on its ground: it is turned so that one axis is the mean normal of "
          "the surface in it. A --height-map then has the cube's square and no empty border; vertices "
          "still lie along the recipe's axes")
      .needs(program.app.option("--patch"));
  program.app
      .add_option(
          "--min-component", request.least_component,
          "leave out pieces and cavities of less volume than this share of the largest piece's; the mesh is "
          "then made twice")
      .check(in_range(0.0, 1.0))
      .default_text("0, all stay");
  program.app.add_flag(
      "--even", request.even,
      "make the triangles more even: vertices move along the surface by about a quarter of a cell, and back "
      "onto it, but for those at the cuts of tiles and patches. Keeps the mesh in memory, about 75 bytes for "
      "each triangle");
  program.app
      .add_option(
          "--height-map", request.height_map,
          "also the patch as a GeoTIFF of metres over its mean plane, and its frame beside it as JSON")
      .placeholder("FILE.tif")
      .writes(height_map_files);
  program.app.add_flag("--points", request.points,
                       "only the mesh's vertices with their outward unit normals, as an oriented point cloud "
                       "(.ply without faces)");
  program.app.add_flag(
      "--labels", request.labels,
      "with each vertex the layer that changed the surface most there (0 = the bare body, 1 = "
      "the recipe's first layer; the file's header says which is which) and the height of "
      "all layers (.ply)");
  program.app.add_flag(
      "--uv", request.texture_coordinates,
      "texture coordinates in a .glb: u = 1/2 + longitude / 360 degrees, v from the north pole to "
      "the south; vertices along the 180th meridian are then there twice");
  request.device.add_to(program.app);
  declare_preview_options(program, request.preview);
  program.app
      .add_option(
          "--gravity", request.gravity.density_and_period,
          "with each vertex potential, acceleration, slope and elevation for this density and this period of "
          "rotation about z, 0 = at rest (.ply)")
      .expected(2)
      .placeholder("KG_M3 HOURS");
  program.app
      .add_option("--feature-list", request.landforms,
                  "also a list of the craters and boulders, those of the recipe and those drawn: places, "
                  "sizes, ages and angles (degrees), in the recipe's unit")
      .placeholder("FILE.csv|FILE.json")
      .writes();
}

namespace {

struct FieldRegion {
  Region region;
  ImplicitField field;
};

// The field of a region; a patch beside the surface is moved onto it.
FieldRegion region_on_surface(Program& program, const Recipe& recipe, const fs::path& file, Region region) {
  constexpr int kMostMoves = 3;  // fine layers are known near a patch alone
  for (int move = 0;; ++move) {
    ImplicitField field = field_of_region(recipe, file, region, program.progress("landforms"));
    const std::optional<Vec3d> beside =
        move < kMostMoves ? surface_beside_patch(field, region) : std::nullopt;
    if (!beside) {
      align_to_ground(field, region);
      return {region, std::move(field)};
    }
    program.say(fmt::format(
        "patch: no surface crosses this cube; moved by {:.4g} {} to {:.9g} {:.9g} {:.9g} on the surface",
        norm(*beside - region.center), recipe.length_unit, beside->x, beside->y, beside->z));
    region.center = *beside;
  }
}

}  // namespace

void make_mesh(Program& program, const MeshRequest& request, const Recipe& recipe, const fs::path& file,
               const fs::path& output) {
  const Region asked = parse_region(request.tile, request.patch, request.aligned);
  check_request(request, asked, recipe, file);
  const auto [region, field] = region_on_surface(program, recipe, file, asked);
  const MeshUse use{!request.preview.file.empty() || !request.height_map.empty(),
                    recipe.erosion.has_value(),
                    request.least_component > 0.0,
                    request.gravity.wanted(),
                    request.labels,
                    request.texture_coordinates,
                    request.even};
  const int resolution = choose_resolution(program, request.size, {field, recipe, region, output, use});
  check_height_map(request.height_map, region, recipe, resolution);
  report_layers_left_out(program, field, recipe, file, region.is_patch);
  if (request.size.only_predict) return;
  if (!region.is_cut()) require_cameras_outside(program, request.preview, field);
  const ChosenDevice chosen = request.device.choose(program, lacking_on_gpu(field, region, resolution));
  const MeshJob job{request, recipe, file, region, field, resolution, output};
  if (chosen || !(request.size.max_memory_gb > 0.0)) return make_files(program, job, chosen);
  try {
    const MemoryGuard guard(memory_limit(request.size.max_memory_gb));
    make_files(program, job, chosen);
  } catch (const std::bad_alloc&) {
    fail_memory(program, request.size, output);
  }
}

void summarize_output(Program& program, const fs::path& output) {
  program.summary["peak_bytes"] = peak_bytes();
  program.summary["sha256"] = sha256_of_file(output);
}

}  // namespace astrolith
