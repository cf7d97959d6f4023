#include "tasks/description/description_jobs.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
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
#include "numerics/length_unit.h"
#include "numerics/srgb.h"
#include "synthesis/picture/colormap.h"
#include "synthesis/picture/phase_curve.h"
#include "tasks/job/job.h"
#include "tasks/job/output_names.h"
#include "tasks/job/picture_options.h"
#include "tasks/repair/mesh_unit.h"

namespace astrolith {
namespace {

constexpr std::array kChannels{"red", "green", "blue"};

struct Arguments {
  std::filesystem::path shape, output;
  std::filesystem::path radiance, phase_curve, light_curve;  // empty = none
  std::string color, title, unit;
  std::vector<double> range;
  double normal_albedo = 0.1, period = 0.0;  // hours
  PictureOptions look;
};

void add_options(Job& job, Arguments& a) {
  OptionTable& app = job.options;
  app.add_option("shape", a.shape, "mesh (" + read_mesh_words() + ")").required().placeholder("MESH").reads();
  app.add_option("-o,--output", a.output,
                 "the picture (.png, .svg, .pdf); needed unless a curve is asked for")
      .placeholder("FILE.png")
      .writes();
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
  app.add_option(
         "--radiance", a.radiance,
         "also the picture as I/F, light over that of a white Lambert disk: 32-bit floats in red, green "
         "and blue, without ambient light, marks and background")
      .placeholder("FILE.tif")
      .writes();
  app.add_option("--normal-albedo", a.normal_albedo,
                 "of the ground in --radiance and in the curves; the laws of hapke and rolo have their own")
      .check(in_range(1e-3, 1.0))
      .placeholder("A");
  app.add_option(
         "--phase-curve", a.phase_curve,
         "a table of the light of the whole body by phase angle, 0 to 150 degrees, with the sun and the "
         "viewer in its equator: means and extremes over a rotation about z, as the area of a white "
         "disk and as magnitudes at 1 AU from both")
      .placeholder("FILE.csv")
      .writes();
  Option light = app.add_option("--light-curve", a.light_curve,
                                "the same over one rotation, at the phase angle of --phase, or 0");
  light.placeholder("FILE.csv").writes();
  app.add_option("--period", a.period, "of rotation in hours, for the times of --light-curve")
      .check(above_zero())
      .needs(light)
      .default_text("")
      .placeholder("HOURS");
}

void check(const Job& job, const Arguments& a) {
  if (a.output.empty() && a.phase_curve.empty() && a.light_curve.empty())
    throw InputError(
        "--output: is required; name the picture to make, such as -o body.png, or ask for a curve");
  if (!a.output.empty()) {
    a.look.check_file(a.output);
    require_writable(a.output);
  } else if (!a.radiance.empty()) {
    throw InputError("--radiance: is of the picture; add -o FILE.png");
  }
  if (!a.radiance.empty()) {
    require_extension(a.radiance, {".tif", ".tiff"});
    require_writable(a.radiance);
  }
  for (const std::filesystem::path& table : {a.phase_curve, a.light_curve}) {
    if (table.empty()) continue;
    require_extension(table, {".csv"});
    require_writable(table);
  }
  if (job.options.option("--normal-albedo").count() > 0 && a.radiance.empty() && a.phase_curve.empty() &&
      a.light_curve.empty())
    throw InputError("--normal-albedo: is of light as a number; add --radiance FILE.tif or a curve");
  a.look.check(job, true, "");
  if (!a.color.empty() && a.radiance.empty() && a.phase_curve.empty() && a.light_curve.empty())
    PictureOptions::refuse_light(job, "--color");
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
  options.colors_are_values = true;
  job.summary["range"] = {range.low, range.high};
  job.say(fmt::format("{}: {}; colours from {:.4g} to {:.4g} of {:.4g} to {:.4g}", a.output.string(), a.color,
                      range.low, range.high, range.least, range.most));
}

bool has_own_colors(const std::filesystem::path& shape) {
  if (mesh_extension(shape) != ".ply") return false;
  const std::vector<std::string> names = ply_value_names(shape);
  return std::ranges::all_of(kChannels,
                             [&](const char* name) { return std::ranges::find(names, name) != names.end(); });
}

// The colours that a .ply has.
void show_own_colors(const Arguments& a, PreviewOptions& options) {
  std::array<std::vector<double>, 3> channels;
  double greatest = 0.0;
  for (std::size_t k = 0; k < 3; ++k) {
    channels[k] = read_ply_values(a.shape, kChannels[k]).values;
    for (const double value : channels[k]) greatest = std::max(greatest, value);
  }
  // Bytes, numbers of 16 bits or shares, as writers have them.
  const double full = greatest <= 1.0 ? 1.0 : greatest <= 255.0 ? 255.0 : 65535.0;
  for (std::size_t i = 0; i < channels[0].size(); ++i) {
    const auto linear = [&](std::size_t k) {
      return static_cast<float>(srgb_to_linear(std::clamp(channels[k][i] / full, 0.0, 1.0)));
    };
    options.vertex_colors.push_back({linear(0), linear(1), linear(2)});
  }
}

// Values of vertices belong to those of the file, which are not merged then.
TriangleMesh read_surface(const Job& job, const Arguments& a, bool shows_colors) {
  TriangleMesh mesh = read_mesh(a.shape);
  if (shows_colors) return orient_faces(std::move(mesh));
  WoundSurface wound = wound_surface(std::move(mesh));
  if (wound.changed()) job.say(a.shape.string() + ": " + wound.words());
  return std::move(wound.mesh);
}

// The picture as I/F, of ground of one albedo.
void write_radiance(Job& job, const Arguments& a, const TriangleMesh& mesh, PreviewOptions options) {
  const auto albedo = static_cast<float>(is_radiance_factor(options.reflectance) ? 1.0 : a.normal_albedo);
  options.vertex_colors.assign(mesh.vertices.size(), {albedo, albedo, albedo});
  options.keep_radiance = true;
  const RenderedPicture picture = render_picture(mesh, options, job.progress("radiance"));
  write_tiff_float(picture.radiance, options.width, options.height, a.radiance, 3);
}

// Magnitudes are of metres; of a unit without a length there are none.
class CurveTable {
 public:
  CurveTable(std::string header, double metres) : text_(std::move(header) + "\n"), metres_(metres) {}

  std::string magnitude(double light) const {
    return metres_ > 0.0 ? fmt::format("{:.5f}", reduced_magnitude(light * metres_ * metres_)) : "";
  }
  void add(const std::string& row) { text_ += row + "\n"; }
  const std::string& text() const { return text_; }

 private:
  std::string text_;
  double metres_;
};

void write_curves(Job& job, const Arguments& a, const TriangleMesh& mesh, const std::string& unit) {
  const DiskOptions options{parse_reflectance("--reflectance", a.look.reflectance), a.normal_albedo};
  const double metres = has_known_length(unit) ? metres_per_unit(unit) : 0.0;
  if (metres == 0.0) job.say("note: magnitudes need a unit of length; add --unit m or km");
  if (!a.phase_curve.empty()) {
    std::vector<double> phases;
    for (int phase = 0; phase <= 150; phase += phase < 10 ? 1 : 5) phases.push_back(phase);
    CurveTable table(
        "phase_deg,light,light_least,light_greatest,magnitude,magnitude_brightest,magnitude_faintest",
        metres);
    for (const PhasePoint& p : phase_curve(mesh, options, phases, job.progress("phase")))
      table.add(fmt::format("{},{:.9g},{:.9g},{:.9g},{},{},{}", p.phase, p.light, p.least, p.greatest,
                            table.magnitude(p.light), table.magnitude(p.greatest), table.magnitude(p.least)));
    write_file(a.phase_curve, table.text());
  }
  if (a.light_curve.empty()) return;
  constexpr int kSteps = 120;
  const double phase = a.look.phase.empty() ? 0.0 : a.look.phase[0];
  CurveTable table(a.period > 0.0 ? "rotation,hours,light,magnitude" : "rotation,light,magnitude", metres);
  const std::vector<double> light = light_curve(mesh, options, phase, kSteps, job.progress("rotation"));
  for (int k = 0; k < kSteps; ++k) {
    const double turn = static_cast<double>(k) / kSteps, s = light[static_cast<std::size_t>(k)];
    const std::string time = a.period > 0.0 ? fmt::format("{:.6g},", turn * a.period) : "";
    table.add(fmt::format("{:.6g},{}{:.9g},{}", turn, time, s, table.magnitude(s)));
  }
  write_file(a.light_curve, table.text());
  const auto [least, greatest] = std::ranges::minmax(light);
  if (least > 0.0)
    job.summary["light_curve_amplitude"] = reduced_magnitude(least) - reduced_magnitude(greatest);
}

void run(Job& job, const Arguments& a) {
  check(job, a);
  const bool own_colors = a.color.empty() && has_own_colors(a.shape);
  const TriangleMesh mesh = read_surface(job, a, own_colors || !a.color.empty());
  job.summary["triangles"] = mesh.triangles.size();
  const std::string unit = resolve_unit(job, a.shape, {a.unit, ""}, {}).name;
  if (!a.phase_curve.empty() || !a.light_curve.empty()) write_curves(job, a, mesh, unit);
  if (a.output.empty()) return;
  PreviewOptions options = a.look.options(job, mesh, unit);
  if (!a.color.empty()) color_by(job, a, options);
  if (own_colors) show_own_colors(a, options);
  if (!a.radiance.empty()) write_radiance(job, a, mesh, options);
  a.look.write(job, render_picture(mesh, options, job.progress("render")), a.output);
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
