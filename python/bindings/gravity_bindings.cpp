#include <nanobind/stl/array.h>
#include <nanobind/stl/filesystem.h>
#include <nanobind/stl/optional.h>
#include <nanobind/stl/string.h>
#include <nanobind/stl/tuple.h>
#include <nanobind/stl/vector.h>

#include <array>
#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <tuple>
#include <utility>
#include <vector>

#include "python/bindings/arrays.h"
#include "python/bindings/job.h"
#include "python/bindings/recipe_text.h"
#include "python/bindings/synthesis_bindings.h"
#include "tasks/gravity/compute_gravity.h"
#include "tasks/gravity/landing_sites.h"

namespace astrolith::python {
namespace {

struct GravityArguments {
  std::string name, unit;
  std::optional<TriangleMesh> mesh;  // else the recipe
  std::string json;
  int resolution = 128;  // of the recipe's mesh
  std::string at;        // "facets" or "vertices"; `points` come first
  std::optional<std::vector<Vec3d>> points;
  GravityOptions options;
  SiteSearch sites;  // a count of 0: none
};

struct GravityTable {
  std::vector<double> rows;
  std::vector<std::string> names;
  std::string figures;
};

GravityPlaces places_of(const GravityArguments& arguments, const TriangleMesh& mesh) {
  if (arguments.points) return {*arguments.points, {}, {}, "points"};
  return arguments.at == "vertices" ? vertex_places(mesh) : facet_places(mesh);
}

GravityTable gravity_table(const GravityArguments& arguments, JobState& state) {
  const StageProgress stage = [&](const std::string& name) { return state.progress(name); };
  const GravityBody body = arguments.mesh ? make_mesh_body(*arguments.mesh, arguments.unit, arguments.name)
                                          : make_recipe_body(loaded_recipe(arguments.json, arguments.name),
                                                             arguments.resolution, arguments.name, stage);
  const ComputedGravity made =
      compute_gravity(body, places_of(arguments, body.mesh), arguments.options, stage);
  nlohmann::ordered_json figures = made.figures;
  for (const GravityColumn& column : made.columns) {
    if (arguments.sites.count == 0 || column.name != "slope_deg") continue;
    figures["sites"] =
        sites_json(find_landing_sites(body, column.values, arguments.sites, stage("sites")), body);
  }
  GravityTable table{interleave(made.columns), {}, figures.dump()};
  for (const GravityColumn& column : made.columns) table.names.push_back(column.name);
  return table;
}

std::tuple<NumpyArray<double>, std::vector<std::string>, std::string> gravity(
    const std::filesystem::path& name, const std::optional<Rows<double>>& vertices,
    const std::optional<Rows<std::uint32_t>>& faces, const std::string& unit, const std::string& json,
    int resolution, const std::string& at, const std::optional<Rows<double>>& points, double density,
    double period, const std::array<double, 3>& axis, double tolerance, bool exact, int sample, int degree,
    double radius, int sites, double site_size, double site_distance, std::uint64_t seed, int threads,
    nb::object progress) {
  GravityArguments arguments{
      name.string(), unit, {}, json, resolution, at, {}, {}, {sites, site_size, site_distance}};
  if (vertices && faces) arguments.mesh = mesh_of(*vertices, *faces, {});
  if (points) arguments.points = points_of(*points);
  arguments.options = {density,   period, normalized(Vec3d{axis[0], axis[1], axis[2]}),
                       tolerance, exact,  sample,
                       seed,      degree, radius};
  GravityTable table = run_job(std::move(progress), threads,
                               [arguments](JobState& state) { return gravity_table(arguments, state); });
  const std::size_t columns = table.names.size(), rows = table.rows.size() / columns;
  return {array_of<double>(std::move(table.rows), {rows, columns}), table.names, table.figures};
}

}  // namespace

void bind_gravity(nb::module_& module) {
  module.def("gravity", &gravity, nb::arg("name"), nb::arg("vertices").noconvert().none(),
             nb::arg("faces").noconvert().none(), nb::arg("unit"), nb::arg("json"), nb::arg("resolution"),
             nb::arg("at"), nb::arg("points").noconvert().none(), nb::arg("density"), nb::arg("period"),
             nb::arg("axis"), nb::arg("tolerance"), nb::arg("exact"), nb::arg("sample"), nb::arg("degree"),
             nb::arg("radius"), nb::arg("sites"), nb::arg("site_size"), nb::arg("site_distance"),
             nb::arg("seed"), nb::arg("threads"), nb::arg("progress").none());
}

}  // namespace astrolith::python
