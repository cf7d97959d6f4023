// describe: a mesh, or points with normals, becomes the histogram of its shape, or the statistics of its
// surface.
#include <filesystem>
#include <string>
#include <utility>

#include "apps/device_option.h"
#include "apps/output_names.h"
#include "apps/program.h"
#include "apps/shape_options.h"
#include "apps/shape_repair.h"
#include "apps/surface_options.h"
#include "cuda/pair_count.h"
#include "geometry/io/mesh_io.h"
#include "numerics/files/npy_file.h"
#include "numerics/files/output_file.h"
#include "tasks/synthesis/describe_file.h"
#include "tasks/synthesis/surface_report.h"

namespace astrolith {
namespace {

struct Arguments {
  std::string shape, output;
  ShapeOptions options;
  ShapeRepair repair;
  DeviceOption device;
  bool surface = false;
  SurfaceOptions surface_options;
};

void add_options(Program& program, Arguments& arguments) {
  CommandLine& app = program.app;
  app.add_option("shape", arguments.shape,
                 "mesh: obj, ply, stl, off, PDS plate .tab, ICQ, bmf; or ply of points with normals")
      .required()
      .placeholder("MESH");
  app.add_option(
         "-o,--output", arguments.output,
         "the frequencies, float64, one axis a feature: alpha beta gamma delta [eta kappa]; with --surface "
         "the figures (.json) or the values at every place (.csv)")
      .required()
      .placeholder("H.npy");
  arguments.options.add_to(app);
  arguments.repair.add_to(app, false);
  arguments.device.add_to(app);
  const Option surface =
      app.add_flag("--surface", arguments.surface,
                   "in place of the histogram: how rough the surface is within 3, 6, 12 and 24 mean edges of "
                   "places all over "
                   "it, whether bumps or pits stand out, how steep it is, and how far its regions differ");
  arguments.surface_options.add_to(app, surface);
}

void summarize(Program& program, const ShapeDescription& shape, const std::string& features) {
  program.summary["points"] = shape.points;
  program.summary["pairs"] = shape.histogram.pairs;
  program.summary["features"] = features;
  program.summary["bins"] = shape.histogram.bins;
  program.summary["max_distance"] = shape.histogram.max_distance;  // in the file's unit
  program.summary["vertices_left_out"] = shape.vertices_left_out;
  program.summary["undefined_curvatures"] = shape.undefined_curvatures;
}

void write_surface(const SurfaceStatistics& surface, const std::string& file) {
  if (std::filesystem::path(file).extension() == ".csv") return write_surface_table(surface, file);
  write_file(file, surface_json(surface).dump(2) + "\n");
}

// Points with normals are described as they are, and wrapped where --wrap is given.
TriangleMesh read_shape(Program& program, const Arguments& arguments, bool or_points) {
  const bool plain = or_points && !arguments.repair.wrap;
  TriangleMesh mesh = plain ? read_mesh_or_points(arguments.shape) : arguments.repair.read(arguments.shape);
  nlohmann::ordered_json figures;
  mesh = arguments.repair.mended_surface(program, std::move(mesh), arguments.shape, figures);
  if (!figures.is_null()) program.summary["repair"] = figures;
  if (const std::string unit = stated_length_unit(arguments.shape); !unit.empty())
    program.summary["length_unit"] = unit;
  return mesh;
}

void run_surface(Program& program, const Arguments& arguments) {
  require_extension(arguments.output, {".json", ".csv"});
  require_writable(arguments.output);
  const TriangleMesh mesh = read_shape(program, arguments, false);
  const SurfaceStatistics surface = describe_surface(
      {arguments.shape, mesh}, arguments.surface_options.of(program), program.progress("surface"));
  for (const std::string& remark : surface.remarks) program.say(arguments.shape + ": " + remark);
  write_surface(surface, arguments.output);
  program.summary["surface"] = surface_json(surface);
  program.say(arguments.output + ": " + std::to_string(surface.places.size()) + " places of " +
              std::to_string(surface.points) + " points");
}

void run(Program& program, const Arguments& arguments) {
  if (arguments.surface) return run_surface(program, arguments);
  require_extension(arguments.output, {".npy"});
  require_writable(arguments.output);
  const TriangleMesh mesh = read_shape(program, arguments, true);
  DescriptionOptions options = arguments.options.with_seed(program.seed);
  const ChosenDevice chosen = arguments.device.choose(program);
  if (chosen) options.count_pairs = count_pairs_on_gpu;
  const Progress progress = program.progress("describe");
  const ShapeDescription shape =
      mesh.triangles.empty() ? describe_file(arguments.shape, mesh.vertices, mesh.normals, options, progress)
                             : describe_file(arguments.shape, mesh, options, progress);
  for (const std::string& remark : shape.remarks) program.say(arguments.shape + ": " + remark);
  const std::vector<int> axes(static_cast<std::size_t>(dimensions(options.features)), options.bins);
  write_npy(shape.histogram.frequencies(), axes, arguments.output);
  summarize(program, shape, arguments.options.features);
  program.say(arguments.output + ": " + std::to_string(shape.points) + " points, " +
              std::to_string(shape.histogram.pairs) + " pairs" + chosen.remark());
}

}  // namespace
}  // namespace astrolith

int main(int argc, char** argv) {
  astrolith::Program program(
      "describe",
      "Writes the histogram of features of pairs of surface points, a fingerprint of the "
      "shape that does not change when the shape is moved, turned or scaled. With --surface it writes what "
      "the surface is like from place to place.");
  astrolith::Arguments arguments;
  astrolith::add_options(program, arguments);
  return program.run(argc, argv, [&] { astrolith::run(program, arguments); });
}
