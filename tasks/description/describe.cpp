#include "tasks/description/description_jobs.h"

#include <filesystem>
#include <initializer_list>
#include <memory>
#include <string>
#include <utility>

#include "cuda/pair_count.h"
#include "geometry/io/mesh_format.h"
#include "geometry/io/mesh_io.h"
#include "numerics/files/npy_file.h"
#include "numerics/files/output_file.h"
#include "tasks/description/describe_file.h"
#include "tasks/description/feature_report.h"
#include "tasks/description/shape_options.h"
#include "tasks/description/surface_report.h"
#include "tasks/job/device_option.h"
#include "tasks/job/job.h"
#include "tasks/job/output_names.h"
#include "tasks/job/picture_options.h"
#include "tasks/repair/shape_repair.h"

namespace astrolith {
namespace {

struct DescribeArguments {
  std::string shape, output;
  ShapeOptions options;
  ShapeRepair repair;
  DeviceOption device;
  bool surface = false;
  SurfaceOptions surface_options;
  std::filesystem::path craters, picture;
  FeatureOptions features;
};

void add_describe_options(Job& job, DescribeArguments& arguments) {
  OptionTable& app = job.options;
  app.add_option("shape", arguments.shape, "mesh (" + read_mesh_words() + "), or .ply of points with normals")
      .required()
      .placeholder("MESH")
      .reads();
  app.add_option("-o,--output", arguments.output,
                 "the frequencies, float64, one axis a feature: alpha beta gamma delta [eta kappa]; with "
                 "--surface the figures (.json) or the values at every place (.csv)")
      .placeholder("H.npy")
      .writes();
  arguments.options.add_to(app);
  arguments.repair.add_to(app, false);
  arguments.device.add_to(app);
  const Option surface = app.add_flag(
      "--surface", arguments.surface,
      "in place of the histogram: how rough the surface is within 3, 6, 12 and 24 mean edges of places all "
      "over it, whether bumps or pits stand out, how steep it is, and how far its regions differ");
  arguments.surface_options.add_to(app, surface);
  Option craters =
      app.add_option("--craters", arguments.craters,
                     "the craters of the surface, the surest first: place, diameter, depth, rim, "
                     "freshness, completeness and confidence of each (.csv or .json)");
  craters.placeholder("FILE.csv").writes();
  app.add_option("--craters-picture", arguments.picture,
                 "with --craters: the mesh with a ring about each likely crater, red to yellow with "
                 "confidence (.png, "
                 ".svg, .pdf)")
      .needs(craters)
      .placeholder("FILE.png")
      .writes();
  app.add_flag("--boulders", arguments.features.boulders,
               "with --craters: large boulders too, in the same table; their depth is their height")
      .needs(craters);
  app.add_option(
         "--crater-points", arguments.features.points,
         "with --craters: evenly spread points that stand for the surface; craters of 6 of their mean "
         "edges and more are found, 500 or more. 0: as many as the mesh has vertices, up to 60,000")
      .check(in_range(std::int64_t{0}, std::int64_t{1'000'000}))
      .needs(craters);
}

void summarize(Job& job, const ShapeDescription& shape, const std::string& features) {
  job.summary["points"] = shape.points;
  job.summary["pairs"] = shape.histogram.pairs;
  job.summary["features"] = features;
  job.summary["bins"] = shape.histogram.bins;
  job.summary["max_distance"] = shape.histogram.max_distance;  // in the file's unit
  job.summary["vertices_left_out"] = shape.vertices_left_out;
  job.summary["undefined_curvatures"] = shape.undefined_curvatures;
}

void write_surface(const SurfaceStatistics& surface, const std::string& file) {
  if (std::filesystem::path(file).extension() == ".csv") return write_surface_table(surface, file);
  write_file(file, surface_json(surface).dump(2) + "\n");
}

// Points with normals are described as they are, and wrapped where --wrap is given.
TriangleMesh read_shape(Job& job, const DescribeArguments& arguments, bool or_points) {
  const bool plain = or_points && !arguments.repair.wrap;
  TriangleMesh mesh = plain ? read_mesh_or_points(arguments.shape) : arguments.repair.read(arguments.shape);
  nlohmann::ordered_json figures;
  mesh = arguments.repair.mended_surface(job, std::move(mesh), arguments.shape, figures);
  if (!figures.is_null()) job.summary["repair"] = figures;
  if (const std::string unit = stated_length_unit(arguments.shape); !unit.empty())
    job.summary["length_unit"] = unit;
  return mesh;
}

void run_surface(Job& job, const DescribeArguments& arguments, const TriangleMesh& mesh) {
  const SurfaceStatistics surface =
      describe_surface({arguments.shape, mesh}, arguments.surface_options.of(job), job.progress("surface"));
  for (const std::string& remark : surface.remarks) job.say(arguments.shape + ": " + remark);
  write_surface(surface, arguments.output);
  job.summary["surface"] = surface_json(surface);
  job.say(arguments.output + ": " + std::to_string(surface.places.size()) + " places of " +
          std::to_string(surface.points) + " points");
}

// Finds the craters, writes them and draws them.
void run_craters(Job& job, const DescribeArguments& arguments, const TriangleMesh& mesh) {
  FeatureOptions options = arguments.features;
  options.seed = job.seed;
  const FoundFeatures found = find_features({arguments.shape, mesh}, options, job.progress("craters"));
  const std::string unit = stated_length_unit(arguments.shape);
  write_found_features(found, unit, arguments.craters);
  job.summary["craters"] = found_json(found);
  if (options.boulders) job.summary["boulders"] = found_json(found, BlobSign::bump);
  job.say(arguments.craters.string() + ": " + job.summary["craters"]["listed"].dump() + " craters, " +
          job.summary["craters"]["likely"].dump() + " of them likely" +
          (options.boulders ? "; " + job.summary["boulders"]["listed"].dump() + " boulders, " +
                                  job.summary["boulders"]["likely"].dump() + " of them likely"
                            : ""));
  if (arguments.picture.empty()) return;
  constexpr std::size_t kMostRings = 200;
  PreviewOptions look;
  look.views = usual_views(mesh);
  look.width = 2048, look.height = 1536;
  look.seed = job.seed;
  look.marks.axes = true;
  look.marks.length_unit = unit;
  add_rings(found, kMostRings, look.marks);
  PictureOptions().write(job, render_picture(mesh, look, job.progress("picture")), arguments.picture);
}

void require_outputs(const DescribeArguments& arguments) {
  if (arguments.output.empty() && arguments.craters.empty())
    throw InputError("nothing to write; name -o H.npy or --craters FILE.csv");
  if (arguments.surface && arguments.output.empty())
    throw InputError("--surface: has nowhere to write; name -o FILE.json or FILE.csv");
  const auto require = [](const std::filesystem::path& file, std::initializer_list<const char*> extensions) {
    if (file.empty()) return;
    require_extension(file, extensions);
    require_writable(file);
  };
  require(arguments.craters, {".csv", ".json"});
  require(arguments.picture, {".png", ".svg", ".pdf"});
  if (arguments.surface) return require(arguments.output, {".json", ".csv"});
  require(arguments.output, {".npy"});
}

void run_describe(Job& job, const DescribeArguments& arguments) {
  require_outputs(arguments);
  const bool histogram_alone = !arguments.surface && arguments.craters.empty();
  const TriangleMesh mesh = read_shape(job, arguments, histogram_alone);
  if (!arguments.craters.empty()) run_craters(job, arguments, mesh);
  if (arguments.output.empty()) return;
  if (arguments.surface) return run_surface(job, arguments, mesh);
  DescriptionOptions options = arguments.options.with_seed(job.seed);
  const ChosenDevice chosen = arguments.device.choose(job);
  if (chosen) options.count_pairs = count_pairs_on_gpu;
  const Progress progress = job.progress("describe");
  const ShapeDescription shape =
      mesh.triangles.empty() ? describe_file(arguments.shape, mesh.vertices, mesh.normals, options, progress)
                             : describe_file(arguments.shape, mesh, options, progress);
  for (const std::string& remark : shape.remarks) job.say(arguments.shape + ": " + remark);
  const std::vector<int> axes(static_cast<std::size_t>(dimensions(options.features)), options.bins);
  write_npy(shape.histogram.frequencies(), axes, arguments.output);
  summarize(job, shape, arguments.options.features);
  job.say(arguments.output + ": " + std::to_string(shape.points) + " points, " +
          std::to_string(shape.histogram.pairs) + " pairs" + chosen.remark());
}

}  // namespace

JobWork declare_describe(Job& job) {
  const auto arguments = std::make_shared<DescribeArguments>();
  add_describe_options(job, *arguments);
  return [&job, arguments] { run_describe(job, *arguments); };
}

}  // namespace astrolith
