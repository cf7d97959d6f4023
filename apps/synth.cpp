// synth: a recipe becomes a closed mesh, a picture of it, or the texture of its Gabor layers.
#include <fmt/format.h>

#include <cstdio>
#include <filesystem>
#include <initializer_list>
#include <memory>
#include <span>
#include <string>
#include <vector>

#include "apps/memory_use.h"
#include "apps/program.h"
#include "apps/synth_size.h"
#include "apps/synth_texture.h"
#include "apps/variations.h"
#include "geometry/mesh_io.h"
#include "geometry/mesh_sink.h"
#include "geometry/ply_stream_writer.h"
#include "numerics/errors.h"
#include "numerics/output_file.h"
#include "recipe/recipe_json.h"
#include "recipe/sha256.h"
#include "synthesis/feature_list.h"
#include "synthesis/image_file.h"
#include "synthesis/implicit_field.h"
#include "synthesis/lay_on_base.h"
#include "synthesis/manifold_check.h"
#include "synthesis/mesher.h"
#include "synthesis/preview.h"

namespace astrolith {
namespace {

namespace fs = std::filesystem;

struct Options {
  fs::path recipe;
  fs::path base;
  fs::path output;
  fs::path preview;
  fs::path features;
  TextureRequest texture;
  MeshSizeRequest size;
  std::string tile;  // "3/16"
  bool points = false;
  double vary = 0.0;  // 0 = the recipe itself
};

void declare_options(Program& program, Options& options) {
  program.app.add_option("recipe", options.recipe, "the recipe, a JSON file")->required();
  program.app
      .add_option("-o,--output", options.output,
                  "the mesh: .ply (binary, streamed), .obj, .stl or .glb, in the recipe's length unit; with "
                  "--texture .png or .tif")
      ->required();
  declare_size_options(program, options.size);
  program.app
      .add_option(
          "--tile", options.tile,
          "only tile I of N, slabs along z that many machines can make: open where cut, with the same "
          "vertices there as the next tile, so that all join without cracks")
      ->option_text("I/N");
  program.app
      .add_option("--base", options.base,
                  "lay the recipe's layers on the body of this recipe, after the layers it has; m and km "
                  "convert")
      ->option_text("BODY.json");
  program.app.add_flag("--points", options.points,
                       "only the mesh's vertices with their outward unit normals, as an oriented point cloud "
                       "(.ply without faces)");
  program.app
      .add_option("--vary", options.vary,
                  "another body of the same kind: the strongest variation that --seed draws whose similarity "
                  "with the recipe's own body, as `compare` measures it, is at least 1 less this")
      ->check(CLI::Range(1e-3, 1.0))
      ->default_str("");
  program.app
      .add_option("--preview", options.preview,
                  "also a picture of the mesh under sunlight, from +x, +y, +z and obliquely")
      ->option_text("FILE.png");
  program.app
      .add_option("--feature-list", options.features,
                  "also a list of the craters and boulders, those of the recipe and those drawn: places, "
                  "sizes, ages and angles (degrees), in the recipe's unit")
      ->option_text("FILE.csv|FILE.json");
  declare_texture_options(program, options.texture);
  for (const char* of_mesh :
       {"--resolution", "--triangles", "--max-memory", "--tile", "--points", "--feature-list", "--vary"}) {
    program.app.get_option("--texture")->excludes(program.app.get_option(of_mesh));
  }
  program.app.get_option("--seed")
      ->description("replaces the recipe's seed when given; with --vary the number of the variation")
      ->default_str("");
}

void require_extension(const fs::path& file, std::initializer_list<const char*> extensions) {
  std::string wanted;
  for (const char* extension : extensions) {
    if (file.extension() == extension) return;
    wanted += (wanted.empty() ? "" : " or ") + std::string(extension);
  }
  throw InputError(file.string() + ": is no " + wanted + " file; name it with that extension");
}

void summarize_output(Program& program, const fs::path& output) {
  program.summary["peak_bytes"] = peak_bytes();
  program.summary["sha256"] = sha256_of_file(output);
}

void make_texture(Program& program, const Options& options, const Recipe& recipe) {
  require_extension(options.output, {".png", ".tif", ".tiff"});
  require_writable(options.output);
  write_texture(program, options.texture, recipe, options.recipe, options.output);
  summarize_output(program, options.output);
}

// The mesh -------------------------------------------------------------------------------------------------

// Passes everything on to several sinks.
class SinkList : public MeshSink {
 public:
  void add(MeshSink& sink) { sinks_.push_back(&sink); }
  void add_vertices(std::span<const MeshVertex> vertices) override {
    for (MeshSink* sink : sinks_) sink->add_vertices(vertices);
  }
  void add_triangles(std::span<const Triangle> triangles) override {
    for (MeshSink* sink : sinks_) sink->add_triangles(triangles);
  }

 private:
  std::vector<MeshSink*> sinks_;
};

// Passes vertices on, not triangles.
class PointsOnly : public MeshSink {
 public:
  explicit PointsOnly(MeshSink& sink) : sink_(sink) {}
  void add_vertices(std::span<const MeshVertex> vertices) override { sink_.add_vertices(vertices); }
  void add_triangles(std::span<const Triangle>) override {}

 private:
  MeshSink& sink_;
};

// The mesh as a promise: closed (a tile: open where it was cut, and only there) and manifold, or no file.
void require_closed_manifold(const ManifoldReport& report, const MeshStatistics& statistics,
                             const Options& options) {
  if (report.triangles == 0) {
    throw WorkError(options.recipe.string() + ": the recipe's surface is empty at this resolution" +
                    (options.tile.empty() ? "; raise it" : " in this tile"));
  }
  if (report.open_vertices != statistics.cut_vertices || report.late_triangles > 0 ||
      report.non_manifold_vertices > 0) {
    throw WorkError("the mesh is not a closed manifold (" + std::to_string(report.open_vertices) +
                    " open and " + std::to_string(report.non_manifold_vertices) +
                    " non-manifold vertices); nothing was written");
  }
}

void summarize_mesh(Program& program, const MeshStatistics& statistics, const ManifoldReport& report) {
  program.summary["vertices"] = report.vertices;
  program.summary["triangles"] = report.triangles;
  program.summary["closed"] = report.closed();
  program.summary["manifold"] = report.manifold();
  program.summary["genus"] = report.genus;
  program.summary["components"] = report.components;
  program.summary["evaluations"] = statistics.evaluations;
  program.summary["cell"] = statistics.step;
  program.summary["active_blocks"] = statistics.active_blocks;
  program.summary["total_blocks"] = statistics.total_blocks;
}

std::string describe_mesh(const ManifoldReport& report, const Options& options) {
  const std::string triangles = options.points
                                    ? std::to_string(report.vertices) + " points of a mesh that is "
                                    : std::to_string(report.triangles) + " triangles, ";
  if (!report.closed()) return triangles + "tile " + options.tile + ", open where cut, manifold";
  return triangles + "closed, manifold, genus " + std::to_string(report.genus) + ", " +
         std::to_string(report.components) + (report.components == 1 ? " component" : " components");
}

// "3/16" is the third of sixteen.
MeshTile parse_tile(const std::string& text) {
  if (text.empty()) return {};
  MeshTile tile;
  char rest = 0;
  if (std::sscanf(text.c_str(), "%6d/%6d%c", &tile.index, &tile.count, &rest) != 2 || tile.index < 1 ||
      tile.index > tile.count) {
    throw InputError("--tile: \"" + text + "\" is no tile; write I/N with I from 1 to N, such as 3/16");
  }
  --tile.index;
  return tile;
}

void make_preview(const Program& program, const Options& options, const TriangleMesh& mesh) {
  PreviewOptions preview;
  preview.seed = program.seed;
  write_png8_rgb(render_preview(mesh, preview, program.progress("preview")), options.preview);
}

void make_mesh(Program& program, const Options& options, const Recipe& recipe) {
  check_mesh_extension(options.output);
  require_writable(options.output);
  if (!options.preview.empty()) {
    require_extension(options.preview, {".png"});
    require_writable(options.preview);
  }
  if (options.points) require_extension(options.output, {".ply"});
  if (!options.features.empty()) {
    require_extension(options.features, {".csv", ".json"});
    require_writable(options.features);
  }
  const MeshTile tile = parse_tile(options.tile);
  const MeshFileInfo info{recipe.length_unit, recipe.frame, "made by " + program.tool()};
  const bool streamed = options.output.extension() == ".ply";
  const ImplicitField field(recipe, options.recipe.string());
  if (field.bounds().empty()) {
    const fs::path& file = options.base.empty() ? options.recipe : options.base;
    throw InputError(file.string() + ": body.iso_value: no point of the body reaches it; lower it");
  }
  const int resolution =
      choose_resolution(program, options.size, field, options.output, !options.preview.empty(), tile.count);

  ManifoldCheck check;
  MeshCollector collector;
  SinkList sinks;
  sinks.add(check);
  if (!streamed || !options.preview.empty()) sinks.add(collector);
  std::unique_ptr<PlyStreamWriter> writer;
  std::unique_ptr<PointsOnly> points;
  if (streamed) {
    writer = std::make_unique<PlyStreamWriter>(options.output, info);
    points = std::make_unique<PointsOnly>(*writer);
    sinks.add(options.points ? static_cast<MeshSink&>(*points) : *writer);
  }
  const MeshStatistics statistics =
      mesh_field(field, field.bounds(), resolution, sinks, program.progress("mesh"), tile);
  const ManifoldReport report = check.finish();
  require_closed_manifold(report, statistics, options);

  if (streamed) {
    writer->finish();
  } else {
    write_mesh(collector.mesh, options.output, info);
  }
  if (!options.preview.empty()) make_preview(program, options, collector.mesh);
  if (!options.features.empty()) {
    write_feature_list(field, recipe.length_unit, options.features);
  }
  summarize_mesh(program, statistics, report);
  summarize_output(program, options.output);
  program.say(options.output.string() + ": " + describe_mesh(report, options));
}

Recipe read_input(const Program& program, const Options& options) {
  Recipe recipe = read_recipe(options.recipe);
  if (!options.base.empty()) {
    recipe = lay_on_base(recipe, options.recipe.string(), read_recipe(options.base), options.base.string());
  }
  if (program.app.get_option("--seed")->count() > 0 && !(options.vary > 0.0)) recipe.seed = program.seed;
  return recipe;
}

Recipe varied(Program& program, const Options& options, const Recipe& recipe) {
  Variation variation =
      find_variation(recipe, reference_of(recipe), options.vary, program.seed, program.progress("vary"));
  program.summary["similarity"] = variation.similarity;
  program.summary["variation_strength"] = variation.strength;
  program.say("variation " + std::to_string(program.seed) + ": similarity " +
              fmt::format("{:.4f}", variation.similarity));
  return std::move(variation.recipe);
}

void synthesize(Program& program, const Options& options) {
  const Recipe recipe = read_input(program, options);
  if (!options.texture.size.empty()) {
    if (!options.preview.empty()) throw InputError("--preview: draws a mesh; leave out --texture");
    return make_texture(program, options, recipe);
  }
  if (options.texture.tileable) throw InputError("--tileable: is about --texture; add --texture WxH");
  if (!recipe.body) {
    throw InputError(options.recipe.string() +
                     ": body: absent; lay its layers on a body with --base BODY.json, or draw its height map "
                     "with --texture WxH");
  }
  make_mesh(program, options, options.vary > 0.0 ? varied(program, options, recipe) : recipe);
}

}  // namespace
}  // namespace astrolith

int main(int argc, char** argv) {
  astrolith::Program program(
      "synth", "Turns a recipe into a closed 2-manifold mesh, or its Gabor layers into a texture.");
  astrolith::Options options;
  astrolith::declare_options(program, options);
  return program.run(argc, argv, [&] { astrolith::synthesize(program, options); });
}
