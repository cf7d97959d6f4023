#include "tasks/gravity/gravity_job.h"

#include <fmt/format.h>

#include <algorithm>
#include <filesystem>
#include <memory>
#include <nlohmann/json.hpp>
#include <string>
#include <string_view>
#include <tuple>
#include <utility>
#include <vector>
#include "tasks/job/body_library.h"

#include "geometry/io/mesh_format.h"
#include "geometry/io/mesh_io.h"
#include "geometry/mesh_measure.h"
#include "gravity/body_mass.h"
#include "numerics/errors.h"
#include "numerics/files/output_file.h"
#include "recipe/recipe_json.h"
#include "tasks/gravity/compute_gravity.h"
#include "tasks/gravity/gravity_body.h"
#include "tasks/gravity/gravity_input.h"
#include "tasks/gravity/gravity_outputs.h"
#include "tasks/gravity/gravity_table.h"
#include "tasks/gravity/landing_sites.h"
#include "tasks/job/density_question.h"
#include "tasks/job/job.h"
#include "tasks/job/load_recipe.h"
#include "tasks/job/output_names.h"
#include "tasks/job/picture_options.h"
#include "tasks/job/words.h"
#include "tasks/repair/shape_repair.h"

namespace astrolith {
namespace {

struct SitesRequest {
  int count = 0;               // 0: none
  double side = 0.0;           // body's unit
  double distance = 0.0;       // body's unit; 0: two sides
  std::filesystem::path list;  // .csv; empty = none
};

double site_distance(const SitesRequest& request) {
  return request.distance > 0.0 ? request.distance : 2.0 * request.side;
}

void write_list(const nlohmann::ordered_json& sites, const std::filesystem::path& file) {
  std::string text =
      "site,x,y,z,normal_x,normal_y,normal_z,latitude_deg,longitude_deg,mean_slope_deg,largest_slope_deg,"
      "roughness_m,cost_deg\n";
  for (std::size_t i = 0; i < sites.size(); ++i) {
    text += std::to_string(i + 1);
    for (const char* vector : {"center", "normal"}) {
      for (const auto& component : sites[i][vector]) text.append(1, ',').append(component.dump());
    }
    for (const char* name : {"latitude_deg", "longitude_deg", "mean_slope_deg", "largest_slope_deg",
                             "roughness_m", "cost_deg"}) {
      text.append(1, ',').append(sites[i][name].dump());
    }
    text += "\n";
  }
  write_file(file, text);
}

// Where a slope exceeds 90 degrees the ground is above what would lie on it: the body turns too fast.
void say_if_nothing_stays(const Job& job, const GravityBody& body, const std::vector<double>& slopes) {
  double steep = 0.0, whole = 0.0;
  for (std::size_t i = 0; i < slopes.size(); ++i) {
    const double area = triangle_area(body.mesh, body.mesh.triangles[i]);
    whole += area;
    if (slopes[i] > 90.0) steep += area;
  }
  if (steep == 0.0) return;
  job.say(fmt::format(
      "note: slopes exceed 90 degrees on {:.3g} % of the ground: at this period nothing stays there",
      100.0 * steep / whole));
}

void declare_sites_options(OptionTable& app, SitesRequest& request) {
  Option sites = app.add_option("--sites", request.count,
                                "also the N best places to land, by the mean slope of a square of ground, "
                                "its roughness about the plane that fits it best, and their distance from "
                                "one another; in the result, and as --patch for synth")
                     .check(in_range(1, 1000))
                     .placeholder("N")
                     .default_text("");
  app.add_option("--site-size", request.side, "side of a site's square, in the body's unit")
      .needs(sites)
      .placeholder("L")
      .default_text("");
  app.add_option("--site-distance", request.distance,
                 "between the centres of two sites at least, in the body's unit")
      .needs(sites)
      .placeholder("D")
      .default_text("2 L");
  app.add_option("--site-list", request.list, "also the sites as a table, best first")
      .needs(sites)
      .placeholder("FILE.csv")
      .writes();
}

// Throws InputError for options that lack one another, for a list that cannot be written, and for sites where
// the places are not facets.
void check_sites(const Job& job, const SitesRequest& request, bool at_facets) {
  if (request.count == 0) return;
  if (!(request.side > 0.0))
    throw InputError("--sites: has no size of a site; add --site-size L, in the body's unit");
  if (job.options.option("--site-distance").count() > 0 && !(request.distance > 0.0))
    throw InputError("--site-distance: must be above 0; leave it out for 2 L");
  if (!at_facets) throw InputError("--sites: needs slopes of facets; leave out --points and --at");
  if (request.list.empty()) return;
  require_extension(request.list, {".csv"});
  require_writable(request.list);
}

// Finds the sites by the slopes among the columns, says them, writes the list, and adds them to the figures.
// `shape` is the body's file. Returns none where none are asked for.
std::vector<LandingSite> landing_sites(Job& job, const SitesRequest& request, const std::string& shape,
                                       const GravityBody& body, const std::vector<GravityColumn>& columns,
                                       nlohmann::ordered_json& figures) {
  if (request.count == 0) return {};
  const auto slopes = std::find_if(columns.begin(), columns.end(),
                                   [](const GravityColumn& column) { return column.name == "slope_deg"; });
  say_if_nothing_stays(job, body, slopes->values);
  const SiteSearch search{request.count, request.side, site_distance(request)};
  std::vector<LandingSite> sites = find_landing_sites(body, slopes->values, search, job.progress("sites"));
  std::erase_if(sites, [](const LandingSite& site) { return site.mean_slope > 90.0; });
  figures["sites"] = sites_json(sites, body);
  const std::string recipe =
      is_recipe_name(find_body(shape)) ? shape : "RECIPE.json";  // of a measured mesh, its fit
  for (std::size_t i = 0; i < sites.size(); ++i) {
    const LandingSite& site = sites[i];
    job.say(
        fmt::format("site {}: slope {:.2f} degrees, {:.2f} at most, roughness {:.3g} m: synth {} --patch {} "
                    "--aligned -o site_{}.ply --height-map site_{}.tif",
                    i + 1, site.mean_slope, site.largest_slope, body.metres * site.roughness, recipe,
                    patch_words(site), i + 1, i + 1));
  }
  if (static_cast<int>(sites.size()) < request.count) {
    job.say(fmt::format("note: the body has {} sites of this size at this distance, not {}", sites.size(),
                        request.count));
  }
  if (!request.list.empty()) write_list(figures["sites"], request.list);
  return sites;
}

using Figures = nlohmann::ordered_json;

std::string numbers(const Figures& list, const char* format) {
  std::string text;
  for (const Figures& number : list) {
    text += (text.empty() ? "" : ", ") + fmt::format(fmt::runtime(format), number.get<double>());
  }
  return text;
}

std::string body_lines(const Figures& figures) {
  const Figures& body = figures["body"];
  const double period = figures["period_h"].get<double>(), density = figures["density_kg_m3"].get<double>();
  const std::string turns = period > 0.0 ? fmt::format("turns once in {:.6g} h", period) : "at rest";
  return fmt::format("mass {:.5g} kg at {:.6g} kg/m3, volume {:.5g} m3, area {:.5g} m2; {}\n",
                     body["mass_kg"].get<double>(), density, body["volume_m3"].get<double>(),
                     body["area_m2"].get<double>(), turns) +
         "centre of mass " + numbers(body["center_of_mass_m"], "{:.4g}") + " m; principal moments " +
         numbers(body["principal_moments_kg_m2"], "{:.4g}") + " kg m2\n";
}

std::string range_line(const Figures& values, const char* column, const char* words, const char* unit) {
  if (!values.contains(column)) return "";
  const Figures& range = values[column];
  const double least = range["min"].get<double>(), most = range["max"].get<double>();
  const std::string text = fmt::format("{:<18} {:11.5g} to {:11.5g}", words, least, most);
  if (std::string_view(column) == "elevation_m") return text + " m above the mean geopotential\n";
  return text + fmt::format(", mean {:11.5g} {}\n", range["mean"].get<double>(), unit);
}

// Ten lines at most. `figures` are those of the job's summary.
std::string gravity_lines(const Figures& figures) {
  const Figures& values = figures["values"];
  std::string text = body_lines(figures);
  text +=
      fmt::format("{} ({}):\n", figures["places"].get<std::string>(), figures["count"].get<std::size_t>());
  text += range_line(values, "potential_J_kg", "potential", "J/kg");
  text += range_line(values, "effective_gravity_m_s2", "effective gravity", "m/s2");
  text += range_line(values, "escape_speed_m_s", "escape speed", "m/s");
  text += range_line(values, "slope_deg", "slope", "degrees");
  text += range_line(values, "elevation_m", "elevation", "m");
  if (figures.contains("achieved_error")) {
    text += fmt::format("largest error of an acceleration at {} places {:.2g}\n",
                        figures["achieved_error"]["sample"].get<std::size_t>(),
                        figures["achieved_error"]["largest"].get<double>());
  }
  return text + "--json prints all figures\n";
}

struct Arguments {
  std::string shape, output, harmonics, preview, points, unit, parts, at = "facets", color = "slope_deg";
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
  app.add_option("-o,--output", a.output,
                 "table of all places (.csv, .npy), or the mesh with values (.ply of vertices, .vtp of both)")
      .placeholder("FILE")
      .writes();
  app.add_option("--density", a.density, "kg/m3, of the whole body").placeholder("N").default_text("");
  app.add_option("--density-of", a.parts,
                 "closed parts inside the body with densities of their own, in the body's unit and frame: "
                 "lobes, boulders, a core, a cavity of 0")
      .placeholder("FILE=N,FILE=N ...")
      .default_text("")
      .reads(part_files);
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
  app.add_option("--harmonics", a.harmonics,
                 "also the harmonics: .gfc (ICGEM), or .sha or .tab (SHADR of the Planetary Data System)")
      .placeholder("FILE")
      .writes();
  app.add_option("--radius", a.radius,
                 "reference radius of the harmonics, in the body's unit; 0 = farthest vertex")
      .check(zero_or_more());
  app.add_option("--resolution", a.resolution, "cells along the longest side of a recipe's body")
      .check(in_range(8, 4096));
  app.add_flag("--json", a.json, "print all figures as JSON, in place of the ten lines that matter");
  declare_sites_options(app, a.sites);
  app.add_option("--preview", a.preview,
                 "also a picture in colours (.png, .svg, .pdf), with a bar; with --sites it has one view "
                 "from above of each of "
                 "the first nine sites, whose ground is orange and carries the site's number")
      .placeholder("FILE.png")
      .writes();
  app.add_option("--color", a.color, "what the colours of the picture say")
      .check(one_of(
          {"slope_deg", "elevation_m", "potential_J_kg", "geopotential_J_kg", "effective_gravity_m_s2"}));
  a.look.add_to(app);
}

Vec3d parse_axis(const Arguments& a) {
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
  parse_axis(a);
  if (!a.points.empty() && (!a.preview.empty() || job.options.option("--at").count() > 0)) {
    throw InputError("--points: gives places of its own; leave out --at and --preview");
  }
  check_sites(job, a.sites, a.at == "facets" && a.points.empty());
  if (!a.output.empty()) {
    require_extension(a.output, {".csv", ".npy", ".ply", ".vtp"});
    if (a.output.ends_with(".ply") && (a.at != "vertices" || !a.points.empty())) {
      throw InputError(a.output +
                       ": a PLY holds values of vertices; add --at vertices, or write .csv, .npy or .vtp");
    }
    if (a.output.ends_with(".vtp") && !a.points.empty())
      throw InputError(a.output + ": holds the mesh, and --points are others; write .csv or .npy");
    require_writable(a.output);
  }
  if (!a.harmonics.empty()) {
    require_extension(a.harmonics, {".gfc", ".sha", ".tab"});
    require_writable(a.harmonics);
  }
  a.look.check(job, !a.preview.empty(), "add --preview FILE.png");
  PictureOptions::refuse_light(job, "gravity --preview");
  if (!a.preview.empty()) {
    a.look.check_file(a.preview);
    require_writable(a.preview);
  }
}

GravityPlaces read_places(const Job& job, const Arguments& a, const GravityBody& body) {
  if (a.points.empty()) return a.at == "vertices" ? vertex_places(body.mesh) : facet_places(body.mesh);
  PointTable table = read_point_table(a.points, body.unit);
  if (!table.words.empty()) job.say("note: " + a.points + ": " + table.words);
  return {std::move(table.points), {}, {}, "points"};
}

GravityOptions gravity_options(const Job& job, const Arguments& a, const GravityBody& body) {
  return {a.density,     a.period,
          parse_axis(a), a.tolerance,
          a.exact,       a.sample,
          job.seed,      a.degree,
          a.radius,      read_parts(job, a.parts, a.unit, body, a.density, a.resolution, a.repair)};
}

void write_outputs(Job& job, const Arguments& a, const GravityBody& body,
                   const std::vector<GravityColumn>& columns, const std::vector<LandingSite>& sites) {
  if (!a.output.empty()) write_gravity(columns, body, a.at == "facets", a.output, job.tool());
  if (a.preview.empty()) return;
  for (const GravityColumn& column : columns) {
    if (column.name == a.color) write_gravity_preview(job, body, column, sites, a.look, a.preview);
  }
}

void run(Job& job, const Arguments& a) {
  check(job, a);
  nlohmann::ordered_json repair;
  const GravityBody body = read_gravity_body(job, a.shape, {a.unit}, a.resolution, a.repair, repair);
  const GravityPlaces places = read_places(job, a, body);
  const ComputedGravity made = compute_gravity(body, places, gravity_options(job, a, body),
                                               [&](const std::string& stage) { return job.progress(stage); });
  nlohmann::ordered_json result{{"shape", a.shape}};
  result.update(made.figures);
  if (!repair.is_null()) result["repair"] = repair;
  const std::vector<LandingSite> sites = landing_sites(job, a.sites, a.shape, body, made.columns, result);
  write_outputs(job, a, body, made.columns, sites);
  if (!a.harmonics.empty())
    write_harmonics(made.figures, a.harmonics, std::filesystem::path(a.shape).stem().string());
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
