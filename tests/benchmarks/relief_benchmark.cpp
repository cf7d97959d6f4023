// Error against bytes of reliefs: heights at several spacings over one fitted base, as compact recipes.
//
//   relief_benchmark MESH... [--spheres 80] [--places 0.2 0.5 1 1.4 3]
#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <filesystem>
#include <vector>

#include "estimation/shape/details/detailed_check.h"
#include "estimation/shape/fit/shape_fit.h"
#include "estimation/shape/relief/relief_fit.h"
#include "geometry/io/mesh_io.h"
#include "geometry/mesh_measure.h"
#include "recipe/recipe_json.h"

namespace {

using namespace astrolith;

struct Table {
  ShapeFitOptions fit;
  std::vector<double> places{0.2, 0.5, 1.0, 1.4, 3.0};  // for each vertex of the mesh
};

void print_rows(const std::string& file, const Table& table) {
  const TargetBody target = prepare_target(read_mesh(file), file);
  const ShapeFitResult base = fit_shape(target, table.fit);
  TriangleMesh surface = target.surface;
  for (Vec3d& p : surface.vertices) p = target.center + target.diagonal * p;
  Recipe recipe;
  recipe.body = base.body;
  const double area = surface_area(surface), vertices = static_cast<double>(surface.vertices.size());
  fmt::print("{}: {} facets, base {} bytes, mean {:.4f} %\n", std::filesystem::path(file).stem().string(),
             surface.triangles.size(), recipe_to_compact(recipe).size(), 100 * base.check.distance.mean);
  for (const double places : table.places) {
    const double spacing = std::sqrt(area / (places * vertices));
    const ReliefFit relief = fit_relief(surface, recipe, {.spacing = spacing});
    Recipe whole = recipe;
    whole.layers = {relief.layer};
    const FitCheck check =
        check_recipe(target, whole, 2 * table.fit.check_resolution, table.fit.check_samples, 1);
    fmt::print("  {:4.1f} places a vertex: {:7} heights {:7} bytes, mean {:.4f} %, max {:.3f} %\n", places,
               relief.heights, recipe_to_compact(whole).size(), 100 * check.distance.mean,
               100 * check.distance.max);
    std::fflush(stdout);
  }
}

}  // namespace

int main(int argc, char** argv) {
  CLI::App app{"Error against bytes of reliefs."};
  std::vector<std::string> files;
  Table table;
  table.fit.spheres = 80;
  app.add_option("meshes", files);
  app.add_option("--spheres", table.fit.spheres);
  app.add_option("--places", table.places);
  CLI11_PARSE(app, argc, argv);
  for (const std::string& file : files) print_rows(file, table);
  return 0;
}
