#include "tasks/gravity/gravity_job.h"

#include <memory>
#include <string>
#include <tuple>
#include <utility>

#include "geometry/io/mesh_format.h"
#include "geometry/io/mesh_io.h"
#include "gravity/body_mass.h"
#include "numerics/errors.h"
#include "numerics/files/output_file.h"
#include "tasks/gravity/compute_gravity.h"
#include "tasks/gravity/gravity_input.h"
#include "tasks/gravity/gravity_lines.h"
#include "tasks/gravity/gravity_outputs.h"
#include "tasks/gravity/gravity_parts.h"
#include "tasks/gravity/gravity_sites.h"
#include "tasks/job/body_library.h"
#include "tasks/job/density_question.h"
#include "tasks/job/job.h"
#include "tasks/job/json_text.h"
#include "tasks/job/load_recipe.h"
#include "tasks/job/output_names.h"
#include "tasks/job/picture_options.h"
#include "tasks/repair/shape_repair.h"

namespace astrolith {
namespace {

struct Arguments {
  std::string shape, output, preview, points, unit, parts, at = "facets", color = "slope_deg";
  double density = 0.0, period = 0.0, tolerance = 1e-7, radius = 0.0;
  std::tuple<double, double, double> axis{0, 0, 1};
  int resolution = 128, degree = 4, sample = 100;
  bool exact = false, json = false;
  ShapeRepair repair;
  PictureOptions look;
  SitesRequest sites;
};

void add_options(Job& job, Arguments& a) {
  OptionTable& app = job.options;
  app.add_option("shape", a.shape,
                 "closed mesh (" + read_mesh_words() + "), recipe (.json, .astro)" + kOrLibraryBody)
      .required()
      .placeholder("SHAPE")
      .reads(recipe_and_images);
  app.add_option("-o,--output", a.output, "table of all places (.csv, .npy), or the mesh with values (.ply)")
      .placeholder("FILE")
      .writes();
  app.add_option("--density", a.density, "kg/m3, of the whole body").placeholder("N").default_text("");
  app.add_option("--density-of", a.parts,
                 "closed parts inside the body with densities of their own, in the body's unit and frame: "
                 "lobes, boulders, a core, a cavity of 0")
      .placeholder("FILE=N,FILE=N ...")
      .default_text("")
      .reads(files_of_parts);
  app.add_option("--period", a.period, "of rotation, hours; without it the body is at rest")
      .placeholder("N")
      .default_text("");
  app.add_option("--axis", a.axis, "axis of rotation, through the centre of mass")
      .placeholder("X Y Z (default 0 0 1)")
      .default_text("");
  app.add_option(
         "--unit", a.unit,
         "length unit of the mesh's coordinates, in place of what its file states; km where neither says one")
      .check(one_of({"m", "km", "cm", "mm"}))
      .default_text("");
  a.repair.add_to(app);
  app.add_option("--at", a.at, "places: centres of facets, or vertices")
      .check(one_of({"facets", "vertices"}));
  app.add_option(
         "--points", a.points,
         "places, inside or outside: lines of x, y, z in the body's unit, or a table whose first line "
         "names its columns, such as id,x_km,y_km,z_km or lat,lon,radius")
      .placeholder("FILE")
      .reads();
  app.add_option("--tolerance", a.tolerance, "bound of the error of each acceleration, relative")
      .check(in_range(1e-12, 0.1));
  app.add_flag("--exact", a.exact, "sum over all facets exactly; takes minutes for 50,000 facets");
  app.add_option(
         "--sample", a.sample,
         "places that are also computed exactly, to state the error achieved; all if there are no more")
      .check(in_range(0, 100000));
  app.add_option("--degree", a.degree, "of the spherical harmonics of gravity")
      .check(in_range(0, kMostDegree));
  app.add_option("--radius", a.radius,
                 "reference radius of the harmonics, in the body's unit; 0 = farthest vertex")
      .check(zero_or_more());
  app.add_option("--resolution", a.resolution, "cells along the longest side of a recipe's body")
      .check(in_range(8, 4096));
  app.add_flag("--json", a.json, "print all figures as JSON, in place of the ten lines that matter");
  declare_sites_options(app, a.sites);
  app.add_option("--preview", a.preview,
                 "also a picture in colours, with a bar; with --sites it has one view from above of each of "
                 "the first nine sites, whose ground is orange and carries the site's number")
      .placeholder("FILE.png")
      .writes();
  app.add_option("--color", a.color, "what the colours of the picture say")
      .check(one_of(
          {"slope_deg", "elevation_m", "potential_J_kg", "geopotential_J_kg", "effective_gravity_m_s2"}));
  a.look.ambient = 0.5;  // keeps colours readable in the shadows
  a.look.add_to(app);
}

Vec3d axis_of(const Arguments& a) {
  const auto& [x, y, z] = a.axis;
  const Vec3d axis = normalized(Vec3d{x, y, z});
  if (!(norm(axis) > 0.5)) throw InputError("--axis: 0 0 0 is no direction; give another");
  return axis;
}

void check(const Job& job, const Arguments& a) {
  if (!(a.density > 0.0)) {
    throw InputError("--density: must be above 0 kg/m3; give one, such as 2000 for an asteroid of rubble");
  }
  question_density(job, a.density);
  if (job.options.option("--period").count() > 0 && !(a.period > 0.0)) {
    throw InputError("--period: must be above 0 hours; leave it out for a body at rest");
  }
  axis_of(a);
  if (!a.points.empty() && (!a.preview.empty() || job.options.option("--at").count() > 0)) {
    throw InputError("--points: gives places of its own; leave out --at and --preview");
  }
  check_sites(job, a.sites, a.at == "facets" && a.points.empty());
  if (!a.output.empty()) {
    require_extension(a.output, {".csv", ".npy", ".ply"});
    if (a.output.ends_with(".ply") && (a.at != "vertices" || !a.points.empty())) {
      throw InputError(a.output +
                       ": a PLY holds values of vertices; add --at vertices, or write .csv or .npy");
    }
    require_writable(a.output);
  }
  a.look.check(job, !a.preview.empty(), "add --preview FILE.png");
  if (!a.preview.empty()) {
    require_extension(a.preview, {".png"});
    require_writable(a.preview);
  }
}

GravityPlaces places_of(const Job& job, const Arguments& a, const GravityBody& body) {
  if (a.points.empty()) return a.at == "vertices" ? vertex_places(body.mesh) : facet_places(body.mesh);
  PointTable table = read_point_table(a.points, body.unit);
  if (!table.words.empty()) job.say("note: " + a.points + ": " + table.words);
  return {std::move(table.points), {}, {}, "points"};
}

GravityOptions options_of(const Job& job, const Arguments& a, const GravityBody& body) {
  return {a.density,  a.period,
          axis_of(a), a.tolerance,
          a.exact,    a.sample,
          job.seed,   a.degree,
          a.radius,   read_parts(job, a.parts, a.unit, body, a.density, a.resolution, a.repair)};
}

void write_outputs(Job& job, const Arguments& a, const GravityBody& body,
                   const std::vector<GravityColumn>& columns, const std::vector<LandingSite>& sites) {
  if (!a.output.empty()) write_gravity(columns, body, a.output, job.tool());
  if (a.preview.empty()) return;
  for (const GravityColumn& column : columns) {
    if (column.name == a.color) write_gravity_preview(job, body, column, sites, a.look, a.preview);
  }
}

void run(Job& job, const Arguments& a) {
  check(job, a);
  nlohmann::ordered_json repair;
  const GravityBody body = read_gravity_body(job, a.shape, {a.unit}, a.resolution, a.repair, repair);
  const GravityPlaces places = places_of(job, a, body);
  const ComputedGravity made = compute_gravity(body, places, options_of(job, a, body),
                                               [&](const std::string& stage) { return job.progress(stage); });
  nlohmann::ordered_json result{{"shape", a.shape}};
  result.update(made.figures);
  if (!repair.is_null()) result["repair"] = repair;
  const std::vector<LandingSite> sites = landing_sites(job, a.sites, a.shape, body, made.columns, result);
  write_outputs(job, a, body, made.columns, sites);
  if (!body.unit_words.empty()) job.say(body.unit_words);
  job.print_result(a.json ? json_text(result) : gravity_lines(result));
  job.summary = result;
}

}  // namespace

JobWork declare_gravity(Job& job) {
  const auto arguments = std::make_shared<Arguments>();
  add_options(job, *arguments);
  return [&job, arguments] { run(job, *arguments); };
}

}  // namespace astrolith
