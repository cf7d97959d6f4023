// What receives synth's mesh while it is made: its file, its box, the certificate of a tile.
#pragma once

#include <filesystem>
#include <memory>
#include <nlohmann/json.hpp>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "geometry/io/mesh_io.h"
#include "geometry/io/ply_stream_writer.h"
#include "geometry/mesh_sink.h"
#include "numerics/errors.h"
#include "recipe/recipe.h"
#include "synthesis/field/implicit_field.h"
#include "synthesis/field/surface_colors.h"
#include "synthesis/field/surface_labels.h"
#include "synthesis/mesh/tile_border.h"
#include "tasks/job/job.h"
#include "tasks/synth/mesh_job.h"
#include "tasks/synth/mesh_region.h"
#include "tasks/synth/tile_certificate.h"

namespace astrolith {

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
class ExtentOfMesh : public MeshSink {
 public:
  void add_vertices(std::span<const MeshVertex> vertices) override {
    for (const MeshVertex& v : vertices) box.extend({v.position.x, v.position.y, v.position.z});
  }
  void add_triangles(std::span<const Triangle>) override {}
  // Measures a finished mesh instead of what was added.
  void measure(const TriangleMesh& mesh) {
    box = {};
    for (const Vec3d& v : mesh.vertices) box.extend(v);
  }

  Box box;
};

// Receives a mesh while it is made, and writes its file. A PLY file is written as the mesh grows, unless
// erosion changes the finished mesh. The other formats, erosion and the picture need the whole mesh in
// memory.
class MeshOutput {
 public:
  MeshOutput(const std::string& tool, const MeshRequest& request, const Recipe& recipe,
             const std::filesystem::path& file, const Region& region, const ImplicitField& field,
             const std::filesystem::path& output)
      : output_(output),
        center_(region.center),
        info_{recipe.length_unit, recipe.frame, "made by " + tool, {}} {
    const MeshFormat& format = written_mesh_format(output);
    if (region.is_patch || !(recipe.origin == Vec3d{})) info_.origin = recipe.origin + region.center;
    info_.whole_body = !region.is_patch;
    info_.texture_coordinates = request.uv == "longitude";
    const bool shows_colors = format.has_colors || !request.preview.file.empty() || request.bake > 0;
    if (has_colors(recipe) && shows_colors) {
      colors_.emplace(recipe, file.string(), field);
    }
    if (request.labels) {
      labels_.emplace(recipe, field, region.cube());
      info_.notes = labels_->legend();
    }
    const bool streamed = format.streamed && !recipe.erosion && !request.gravity.wanted();
    const bool collected = !request.preview.file.empty() || request.has_maps() || request.levels > 1;
    if (!streamed || collected) sinks_.add(collector_);
    if (streamed) stream(request.points);
  }
  MeshOutput(const MeshOutput&) = delete;
  MeshOutput& operator=(const MeshOutput&) = delete;

  MeshSink& sink() { return sinks_; }
  // The mesh in memory; empty where nothing needs it there.
  TriangleMesh& collected() { return collector_.mesh; }

  // Paints the mesh in memory. Call it when the mesh is complete.
  void paint() { paint(collector_.mesh); }
  void paint(TriangleMesh& mesh) const {
    if (colors_) mesh.colors = colors_->colors_of(center_, mesh);
  }
  const MeshFileInfo& info() const { return info_; }
  // Lays texture coordinates and maps on the mesh.
  void set_skin(std::shared_ptr<const MeshSkin> skin) { info_.skin = std::move(skin); }
  // The colours of the recipe's layers; null where nothing shows them.
  const SurfaceColors* colors() const { return colors_ ? &*colors_ : nullptr; }

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

  std::filesystem::path output_;
  Vec3d center_;  // of the patch; 0 for a whole mesh
  MeshFileInfo info_;
  std::optional<SurfaceColors> colors_;  // absent where nothing shows them
  std::optional<SurfaceLabels> labels_;
  MeshCollector collector_;
  std::unique_ptr<PlyStreamWriter> writer_;
  std::unique_ptr<PointsOnly> points_;
  SinkList sinks_;
};

// Measures a tile while it is made, and certifies it in the summary.
class TileRecord {
 public:
  TileRecord(const ImplicitField& field, int resolution, MeshTile tile)
      : resolution_(resolution), tile_(tile), border_(border_of(planes_of_tile(field, resolution, tile))) {}

  MeshSink& sink() { return border_; }

  // Call it when the mesh is complete. Throws WorkError where the tile is open elsewhere than in its sides:
  // it has so many vertices at open edges.
  void finish(std::int64_t open_vertices) {
    const std::optional<TileFigures> figures = border_.figures();
    if (!figures || figures->border_vertices() != open_vertices)
      throw WorkError("the tile is open elsewhere than where it was cut; nothing was written");
    figures_ = *figures;
  }

  // Adds the certificate to a summary that has the hash of the mesh.
  void add_to_summary(Job& job, const Recipe& recipe, const std::filesystem::path& output) const {
    job.summary["tile"] = to_json(TileCertificate{.number = tile_.index + 1,
                                                  .count = tile_.count,
                                                  .recipe_sha256 = hash_of_recipe(recipe),
                                                  .resolution = resolution_,
                                                  .length_unit = recipe.length_unit,
                                                  .file = output.filename().string(),
                                                  .file_sha256 = job.summary["sha256"],
                                                  .figures = figures_});
  }

 private:
  static TileBorder border_of(const TilePlanes& planes) { return {planes.lower, planes.upper}; }

  int resolution_;
  MeshTile tile_;
  TileBorder border_;
  TileFigures figures_;
};

}  // namespace astrolith
