// render: a mesh becomes a sunlit picture, in colours of one property of its vertices where asked for.
#include <fmt/format.h>

#include <cmath>
#include <filesystem>
#include <string>
#include <vector>

#include "apps/program.h"
#include "geometry/io/mesh_io.h"
#include "geometry/io/ply_values.h"
#include "numerics/errors.h"
#include "numerics/files/output_file.h"
#include "synthesis/picture/colormap.h"
#include "tasks/job/output_names.h"
#include "tasks/repair/mesh_unit.h"
#include "tasks/synthesis/picture_options.h"

namespace astrolith {
namespace {

struct Arguments {
  std::filesystem::path shape, output;
  std::string color, title, unit;
  std::vector<double> range;
  PictureOptions look;
};

void add_options(Program& program, Arguments& a) {
  OptionTable& app = program.app;
  app.add_option("shape", a.shape, "mesh: obj, ply, stl, off, PDS plate .tab, ICQ, bmf")
      .required()
      .placeholder("MESH")
      .reads();
  app.add_option("-o,--output", a.output, "the picture").required().placeholder("FILE.png").writes();
  Option color = app.add_option(
      "--color", a.color,
      "colours by this property of the vertices of a .ply, such as slope_deg of gravity -o, with "
      "a bar below the views");
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

void check(const Program& program, const Arguments& a) {
  require_extension(a.output, {".png"});
  require_writable(a.output);
  a.look.check(program, true, "");
  if (a.range.empty()) return;
  if (!(a.range[0] < a.range[1]) || !std::isfinite(a.range[1] - a.range[0]))
    throw InputError("--range: the first number must be below the second; swap them");
}

void color_by(Program& program, const Arguments& a, PreviewOptions& options) {
  const std::vector<double> values = read_ply_values(a.shape, a.color).values;
  ValueRange range = value_range(values);
  if (!a.range.empty()) range.low = a.range[0], range.high = a.range[1];
  options.vertex_colors = sequential_colors(values, range.low, range.high);
  options.marks.values = {range.low, range.high, a.title.empty() ? title_of_column(a.color) : a.title};
  if (program.app.option("--ambient").count() == 0) options.ambient = 0.5;  // keeps colours readable
  program.summary["range"] = {range.low, range.high};
  program.say(fmt::format("{}: {}; colours from {:.4g} to {:.4g} of {:.4g} to {:.4g}", a.output.string(),
                          a.color, range.low, range.high, range.least, range.most));
}

void run(Program& program, const Arguments& a) {
  check(program, a);
  const TriangleMesh mesh = read_mesh(a.shape);
  PreviewOptions options = a.look.options(program, mesh, unit_of_mesh(program, a.shape, {a.unit, ""}, {}));
  if (!a.color.empty()) color_by(program, a, options);
  a.look.write(program, render_picture(mesh, options, program.progress("render")), a.output);
  program.summary["triangles"] = mesh.triangles.size();
  program.summary["width"] = options.width;
  program.summary["height"] = options.height;
}

}  // namespace
}  // namespace astrolith

int main(int argc, char** argv) {
  astrolith::Program program("render",
                             "Draws a sunlit picture of a mesh, with shadows; a .ply also in the colours of "
                             "a property of its vertices.");
  astrolith::Arguments arguments;
  astrolith::add_options(program, arguments);
  return program.run(argc, argv, [&] { astrolith::run(program, arguments); });
}
