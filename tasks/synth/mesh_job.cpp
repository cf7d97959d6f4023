#include "tasks/synth/mesh_job.h"

#include <fmt/format.h>

#include <new>
#include <optional>
#include <utility>

#include "numerics/errors.h"
#include "numerics/files/sha256.h"
#include "numerics/length_unit.h"
#include "numerics/memory_use.h"
#include "numerics/process_limits.h"
#include "synthesis/field/feature_list.h"
#include "synthesis/field/surface_colors.h"
#include "synthesis/field/surface_labels.h"
#include "tasks/job/words.h"
#include "tasks/synth/bake.h"
#include "tasks/synth/detail_levels.h"
#include "tasks/synth/ground_maps.h"
#include "tasks/synth/mesh_prediction.h"
#include "tasks/synth/mesh_reports.h"
#include "tasks/synth/surface_gravity.h"
#include "tasks/synth/tile_certificate.h"

namespace astrolith {
namespace {

namespace fs = std::filesystem;

// Passes vertices on, not triangles.
class PointsOnly : public MeshSink {
 public:
  explicit PointsOnly(MeshSink& sink) : sink_(sink) {}
  void add_vertices(std::span<const MeshVertex> vertices) override { sink_.add_vertices(vertices); }
  void add_triangles(std::span<const Triangle>) override {}

 private:
  MeshSink& sink_;
};

// Measures the box of all vertices.
class MeshExtent : public MeshSink {
 public:
  void add_vertices(std::span<const MeshVertex> vertices) override {
    for (const MeshVertex& v : vertices) box.extend({v.position.x, v.position.y, v.position.z});
  }
  void add_triangles(std::span<const Triangle>) override {}

  Box box;
};

// Receives a mesh while it is made. A PLY file is written as the mesh grows, unless erosion or gravity wait
// for the finished mesh. Whatever else becomes of the mesh needs it in memory.
class MeshOutput : public SinkList {
 public:
  MeshOutput(const std::string& tool, const MeshJob& job, const MeshPart& part)
      : spec_(job.spec),
        sinks_(job.sinks),
        center_(part.region.center),
        info_{part.recipe.length_unit, part.recipe.frame, "made by " + tool, {}} {
    const MeshFormat& format = sinks_.format();
    if (part.region.is_patch || !(part.recipe.origin == Vec3d{}))
      info_.origin = part.recipe.origin + part.region.center;
    info_.whole_body = !part.region.is_patch;
    info_.texture_coordinates = spec_.uv == "longitude";
    const bool shows_colors = format.has_colors || !sinks_.preview.file.empty() || sinks_.bake > 0;
    if (has_colors(part.recipe) && shows_colors) colors_.emplace(part.recipe, part.file.string(), part.field);
    if (spec_.labels) {
      labels_.emplace(part.recipe, part.field, part.region.cube());
      info_.notes = labels_->legend();
    }
    const bool streamed =
        format.streamed && !sinks_.file.empty() && !part.recipe.erosion && spec_.gravity.empty();
    if (!streamed || sinks_.need_whole()) add(collector_);
    if (streamed) stream();
  }
  MeshOutput(const MeshOutput&) = delete;
  MeshOutput& operator=(const MeshOutput&) = delete;

  // The mesh in memory; empty where nothing needs it there.
  TriangleMesh& collected() { return collector_.mesh; }
  const SurfaceColors* colors() const { return colors_ ? &*colors_ : nullptr; }  // null: nothing shows them

  // Paints a complete mesh.
  void paint(TriangleMesh& mesh) const {
    if (colors_) mesh.colors = colors_->evaluate_colors(center_, mesh);
  }

  // Completes all files of the mesh. Before that they do not exist. Quantities, if any, are properties of the
  // vertices.
  void write(Job& job, const MeshPart& part, const std::vector<VertexValues>& quantities) {
    std::vector<DetailLevel> coarser = coarser_levels(job, part, sinks_.levels, collector_.mesh);
    std::vector<MeshLevel> levels{{&collector_.mesh}};
    for (DetailLevel& level : coarser) {
      paint(level.mesh);
      levels.push_back({&level.mesh});
    }
    if (spec_.has_charts()) {
      add_skins(job, sinks_, part, colors(), levels);
      info_.skin = levels.front().skin;
    }
    if (writer_) {
      writer_->finish();
    } else if (!quantities.empty()) {
      write_ply_values(collector_.mesh, quantities, sinks_.file, info_);
    } else if (coarser.empty() || level_file(sinks_.file, 1) != sinks_.file) {
      write_mesh(collector_.mesh, sinks_.file, info_);
    }
    if (!coarser.empty()) write_levels(job, sinks_.file, part.resolution, coarser, levels, info_);
  }

  // Hands the mesh over to a caller.
  void hand_over(Job& job, const MeshPart& part, std::vector<VertexValues> quantities) {
    job.summary["resolution"] = part.resolution;
    KeptMesh kept{sinks_.member, std::move(collector_.mesh), {},         std::move(quantities),
                  info_,         part.region.plane,          job.summary};
    if (spec_.points) kept.mesh.triangles.clear();
    if (labels_) {
      std::vector<MeshVertex> vertices;
      for (const Vec3d& v : kept.mesh.vertices) vertices.push_back({to_float(v), {}});
      kept.labels.resize(vertices.size());
      labels_->label(center_, vertices, kept.labels);
    }
    sinks_.arrays(std::move(kept));
  }

 private:
  void stream() {
    VertexLabeller labeller;
    VertexPainter painter;
    if (labels_) labeller = [this](auto vertices, auto out) { labels_->label(center_, vertices, out); };
    if (colors_) painter = [this](auto vertices, auto out) { colors_->paint(center_, vertices, out); };
    writer_.emplace(sinks_.file, info_, std::move(labeller), std::move(painter));
    points_.emplace(*writer_);
    add(spec_.points ? static_cast<MeshSink&>(*points_) : *writer_);
  }

  const MeshSpec& spec_;
  const MeshSinks& sinks_;
  Vec3d center_;  // of the patch; 0 for a whole mesh
  MeshFileInfo info_;
  std::optional<SurfaceColors> colors_;  // absent where nothing shows them
  std::optional<SurfaceLabels> labels_;
  MeshCollector collector_;
  std::optional<PlyStreamWriter> writer_;
  std::optional<PointsOnly> points_;
};

// The certificate of a tile whose border has been recorded. Throws WorkError where the tile is open elsewhere
// than in its sides.
TileFigures tile_figures(TileBorder& border, const ManifoldReport& report) {
  const std::optional<TileFigures> figures = border.figures();
  if (!figures || figures->border_vertices() != report.open_vertices)
    throw WorkError("the tile is open elsewhere than where it was cut; nothing was written");
  return *figures;
}

// Programs take lengths of a file that states no unit for kilometres.
void say_unstated_unit(const Job& job, const std::string& unit, const MeshSinks& sinks) {
  if (unit == "km" || !has_known_length(unit) || sinks.format().tells_unit) return;
  job.say(fmt::format("note: a {} states no unit; read it with --unit {}", mesh_extension(sinks.file), unit));
}

// Makes the mesh and all that becomes of it.
void make_files(Job& job, const MeshJob& mesh, const MeshPart& part, const ChosenDevice& chosen) {
  const auto& [spec, sinks, device, max_memory_gb, only_predict] = mesh;
  const Recipe& recipe = part.recipe;
  const Region& region = part.region;
  MeshOutput output(job.tool(), mesh, part);
  MeshExtent extent;
  output.add(extent);
  std::optional<TileBorder> border;
  if (!spec.tile.empty() && !spec.points && !sinks.file.empty()) {
    const TilePlanes planes = tile_planes(part.field, part.resolution, region.tile);
    output.add(border.emplace(planes.lower, planes.upper));
  }
  BodyMeshReport made = make_body_mesh(part, output, job.stages());
  const TileFigures border_figures = border ? tile_figures(*border, made.manifold) : TileFigures{};
  report_making(job, part, made);
  TriangleMesh& collected = output.collected();
  if (recipe.erosion) {
    const ErosionStatistics done = erode_body(*recipe.erosion, collected, job.progress("erosion"));
    report_erosion(job, *recipe.erosion, done, collected.vertices.size());
    extent.box = collected.bounds();
  }
  require_cameras_outside(job, sinks.preview, collected);
  output.paint(collected);
  std::optional<SurfaceGravity> gravity;
  std::vector<VertexValues> quantities;
  if (!spec.gravity.empty()) {
    const PatchBody body = region.is_patch ? make_patch_body(job, part) : PatchBody{};
    gravity.emplace(job, part, region.is_patch ? body.mesh : collected);
    quantities =
        gravity->at_vertices(job, collected, region.center, region.is_patch ? body.coarse : collected);
  }
  if (!sinks.file.empty()) output.write(job, part, quantities);
  say_unstated_unit(job, recipe.length_unit, sinks);
  if (const auto counts = sinks.format().counts) {
    const MeshCounts kept = counts({made.manifold.vertices, made.manifold.triangles});
    made.manifold.vertices = kept.vertices, made.manifold.triangles = kept.triangles;
  }
  if (!sinks.preview.file.empty()) write_preview(job, sinks.preview, collected, recipe.length_unit);
  if (!sinks.preview.maps.empty())
    write_preview_maps(job, sinks.preview, collected, part, made.statistics.step);
  write_ground_maps(job, sinks, part, collected, gravity ? &*gravity : nullptr);
  if (!sinks.landforms.empty())
    write_feature_list(part.field, recipe, region.cube(), made.statistics.step, sinks.landforms);
  report_mesh(job, mesh, part, made);
  if (sinks.arrays) output.hand_over(job, part, std::move(quantities));
  if (sinks.file.empty()) return;
  summarize_output(job, sinks.file);
  if (border) {
    job.summary["tile"] = to_json(TileCertificate{.number = region.tile.index + 1,
                                                  .count = region.tile.count,
                                                  .recipe_sha256 = hash_recipe(recipe),
                                                  .resolution = part.resolution,
                                                  .length_unit = recipe.length_unit,
                                                  .file = sinks.file.filename().string(),
                                                  .file_sha256 = job.summary["sha256"],
                                                  .figures = border_figures});
  }
  const std::string name = sinks.file.string();
  if (made.manifold.triangles == 0) return job.say(name + ": no surface lies in tile " + spec.tile);
  job.say(name + ": " + describe(spec, made.manifold) + ", " +
          size_words(extent.box.extent(), recipe.length_unit) + chosen.remark());
}

// Does the work with the part's device, and again on the CPU where the GPU fails.
template <class Work>
auto on_device(Job& job, const MeshJob& mesh, MeshPart& part, ChosenDevice chosen, const Work& work) {
  part.device = chosen ? MeshingDevice::kGpu : MeshingDevice::kCpu;
  try {
    return work(chosen);
  } catch (const DeviceError& error) {
    if (!chosen) throw;
    chosen = mesh.device.after_failure(job, error);
    part.device = MeshingDevice::kCpu;
  }
  return work(chosen);
}

}  // namespace

void make_mesh(Job& job, const MeshJob& mesh, const Recipe& recipe, const fs::path& file) {
  check_mesh(mesh, recipe, file);
  const MeshSinks& sinks = mesh.sinks;
  MeshPart part = make_body_part(mesh.spec, recipe, file, sinks.has_ground_maps() || sinks.arrays,
                                 job.progress("landforms"), [&](const std::string& line) { job.say(line); });
  // Meshes that are made to be counted are made by the device that makes the mesh.
  part.resolution = on_device(job, mesh, part, {mesh.device.has_gpu(), ""},
                              [&](const ChosenDevice&) { return choose_resolution(job, mesh, part); });
  check_ground_maps(sinks, part);
  check_levels(sinks.levels, part.resolution);
  report_layers_left_out(job, part);
  if (mesh.only_predict) return;
  if (!part.region.is_cut()) require_cameras_outside(job, sinks.preview, part.field);
  part.may_be_empty = part.region.tile.count > 1 && sinks.format().streamed && !sinks.need_whole();
  on_device(job, mesh, part, mesh.device.choose(job, lacking_on_gpu(part)), [&](const ChosenDevice& chosen) {
    std::optional<MemoryGuard> guard;
    if (mesh.max_memory_gb > 0.0) guard.emplace(memory_limit(mesh.max_memory_gb));
    try {
      make_files(job, mesh, part, chosen);
    } catch (const std::bad_alloc&) {
      if (!guard) throw;
      guard.reset();
      fail_memory(job, mesh);
    }
  });
}

void summarize_output(Job& job, const fs::path& output) {
  job.summary["peak_bytes"] = peak_bytes();
  job.summary["sha256"] = file_sha256(output);
}

}  // namespace astrolith
