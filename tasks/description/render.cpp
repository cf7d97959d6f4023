#include "tasks/description/description_jobs.h"

#include <fmt/format.h>

#include <cmath>
#include <filesystem>
#include <memory>
#include <string>
#include <vector>

#include "geometry/io/mesh_format.h"
#include "geometry/io/mesh_io.h"
#include "geometry/io/ply_values.h"
#include "geometry/wound_surface.h"
#include "numerics/errors.h"
#include "numerics/files/output_file.h"
#include "synthesis/picture/colormap.h"
#include "tasks/job/job.h"
#include "tasks/job/output_names.h"
#include "tasks/job/picture_options.h"
#include "tasks/repair/mesh_unit.h"

namespace astrolith {
namespace {

struct Arguments {
  std::filesystem::path shape, output;
  std::string color, title, unit;
  std::vector<double> range;
  PictureOptions look;
};

void add_options(Job& job, Arguments& a) {
  OptionTable& app = job.options;
  app.add_option("shape", a.shape, "mesh (" + read_mesh_words() + ")").required().placeholder("MESH").reads();
  app.add_option("-o,--output", a.output, "the picture").required().placeholder("FILE.png").writes();
  Option color = app.add_option("--color", a.color,
                                "colours by this property of the vertices of a .ply, such as slope_deg of "
                                "gravity -o, with a bar below the views");
  color.placeholder("NAME");
  app.add_option("--range", a.range, "the values at the ends of the bar (default: 1st and 99th percentile)")
      .expected(2)
      .needs(color)
      .placeholder("LOW HIGH")
      .default_text("");
  app.add_option("--title", a.title, "quantity and unit on the bar (default: from the property's name)")
      .needs(color)
      .placeholder("TEXT");
  app.add_option("--unit", a.unit,
                 "the unit of the mesh's lengths, for the scale, in place of what the file states")
      .placeholder("UNIT");
  a.look.add_to(app);
}

void check(const Job& job, const Arguments& a) {
  require_extension(a.output, {".png"});
  require_writable(a.output);
  a.look.check(job, true, "");
  if (a.range.empty()) return;
  if (!(a.range[0] < a.range[1]) || !std::isfinite(a.range[1] - a.range[0]))
    throw InputError("--range: the first number must be below the second; swap them");
}

void color_by(Job& job, const Arguments& a, PreviewOptions& options) {
  const std::vector<double> values = read_ply_values(a.shape, a.color).values;
  ValueRange range = value_range(values);
  if (!a.range.empty()) range.low = a.range[0], range.high = a.range[1];
  options.vertex_colors = sequential_colors(values, range.low, range.high);
  options.marks.values = {range.low, range.high, a.title.empty() ? column_title(a.color) : a.title};
  if (job.options.option("--ambient").count() == 0) options.ambient = 0.5;  // keeps colours readable
  job.summary["range"] = {range.low, range.high};
  job.say(fmt::format("{}: {}; colours from {:.4g} to {:.4g} of {:.4g} to {:.4g}", a.output.string(), a.color,
                      range.low, range.high, range.least, range.most));
}

// Values of vertices belong to those of the file, which are not merged then.
TriangleMesh read_surface(const Job& job, const Arguments& a) {
  TriangleMesh mesh = read_mesh(a.shape);
  if (!a.color.empty()) return orient_faces(std::move(mesh));
  WoundSurface wound = wound_surface(std::move(mesh));
  if (wound.changed()) job.say(a.shape.string() + ": " + wound.words());
  return std::move(wound.mesh);
}

void run(Job& job, const Arguments& a) {
  check(job, a);
  const TriangleMesh mesh = read_surface(job, a);
  PreviewOptions options = a.look.options(job, mesh, resolve_unit(job, a.shape, {a.unit, ""}, {}).name);
  if (!a.color.empty()) color_by(job, a, options);
  a.look.write(job, render_picture(mesh, options, job.progress("render")), a.output);
  job.summary["triangles"] = mesh.triangles.size();
  job.summary["width"] = options.width;
  job.summary["height"] = options.height;
}

}  // namespace

JobWork declare_render(Job& job) {
  const auto arguments = std::make_shared<Arguments>();
  add_options(job, *arguments);
  return [&job, arguments] { run(job, *arguments); };
}

}  // namespace astrolith
