#include "tasks/gravity/gravity_sites.h"

#include <fmt/format.h>

#include <algorithm>

#include "geometry/mesh_measure.h"
#include "numerics/errors.h"
#include "numerics/files/output_file.h"
#include "recipe/recipe_json.h"
#include "tasks/job/body_library.h"
#include "tasks/job/output_names.h"

namespace astrolith {
namespace {

double distance_of(const SitesRequest& request) {
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

}  // namespace

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

void check_sites(const Job& job, const SitesRequest& request, bool of_facets) {
  if (request.count == 0) return;
  if (!(request.side > 0.0))
    throw InputError("--sites: has no size of a site; add --site-size L, in the body's unit");
  if (job.options.option("--site-distance").count() > 0 && !(request.distance > 0.0))
    throw InputError("--site-distance: must be above 0; leave it out for 2 L");
  if (!of_facets) throw InputError("--sites: needs slopes of facets; leave out --points and --at");
  if (request.list.empty()) return;
  require_extension(request.list, {".csv"});
  require_writable(request.list);
}

std::vector<LandingSite> landing_sites(Job& job, const SitesRequest& request, const std::string& shape,
                                       const GravityBody& body, const std::vector<GravityColumn>& columns,
                                       nlohmann::ordered_json& figures) {
  if (request.count == 0) return {};
  const auto slopes = std::find_if(columns.begin(), columns.end(),
                                   [](const GravityColumn& column) { return column.name == "slope_deg"; });
  say_if_nothing_stays(job, body, slopes->values);
  const SiteSearch search{request.count, request.side, distance_of(request)};
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

}  // namespace astrolith
