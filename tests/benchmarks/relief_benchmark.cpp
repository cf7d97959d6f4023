// Error against bytes of reliefs: heights at several spacings and steps over one fitted base, as compact
// recipes. Also the rate of one core at which the heights of a relief are evaluated.
//
//   relief_benchmark MESH... [--spheres 80] [--places 0.2 0.5 1 1.4 3] [--steps 4]
#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <filesystem>
#include <vector>

#include "estimation/shape/details/detailed_check.h"
#include "estimation/shape/fit/shape_fit.h"
#include "estimation/shape/relief/relief_fit.h"
#include "geometry/io/mesh_io.h"
#include "geometry/mesh_measure.h"
#include "numerics/hash_random.h"
#include "numerics/parallel_for.h"
#include "recipe/recipe_json.h"
#include "synthesis/field/field_tables.h"
#include "synthesis/field/implicit_field.h"
#include "tests/benchmarks/processor_seconds.h"
#include "tests/support/meshes.h"

namespace {

using namespace astrolith;

struct Table {
  ShapeFitOptions fit;
  std::vector<double> places{0.2, 0.5, 1.0, 1.4, 3.0};  // for each vertex of the mesh
  std::vector<double> steps{4.0};                       // in mean residuals of the finest relief
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
    for (const double step : table.steps) {
      const double spacing = std::sqrt(area / (places * vertices));
      ReliefFit relief;
      const double seconds =
          processor_seconds([&] { relief = fit_relief(surface, recipe, {.spacing = spacing}); });
      if (step != 4.0) {
        relief = fit_relief(surface, recipe, {.spacing = spacing, .step = step / 4.0 * relief.layer.step()});
      }
      Recipe whole = recipe;
      whole.layers = {relief.layer};
      const FitCheck check =
          check_recipe(target, whole, 2 * table.fit.check_resolution, table.fit.check_samples, 1);
      fmt::print(
          "  {:4.1f} places a vertex, step {:4.1f}: {:7} heights {:7} bytes, mean {:.4f} % ({:.3f} of the "
          "base), "
          "max {:.3f} %, {:.1f} s\n",
          places, step, relief.heights, recipe_to_compact(whole).size(), 100 * check.distance.mean,
          check.distance.mean / base.check.distance.mean, 100 * check.distance.max, seconds);
      std::fflush(stdout);
    }
  }
}

// Points of a ball in batches as a mesher asks for them: blocks of neighbours.
void print_rate() {
  Recipe ball;
  ball.body = MetaballBody{};
  ball.body->spheres = {{{}, 1.0}};
  TriangleMesh surface = testing::icosphere(6, 1.01);
  ball.layers = {fit_relief(surface, ball, {.spacing = 0.01}).layer};
  const ImplicitField field(ball);
  const ReliefNoise& noise = *field.tables().layers[0].noise.get_if<ReliefNoise>();
  constexpr int kBatch = 1024, kBatches = 2000;
  std::vector<float> x(kBatch), y(kBatch), z(kBatch), height(kBatch);
  CounterRandom random(1);
  double seconds = 0.0;
  for (int b = 0; b < kBatches; ++b) {
    const Vec3d middle = normalized(Vec3d{random.normal(), random.normal(), random.normal()});
    for (std::size_t i = 0; i < kBatch; ++i) {
      const Vec3d p = normalized(middle + 0.02 * Vec3d{random.uniform(), random.uniform(), random.uniform()});
      x[i] = static_cast<float>(p.x), y[i] = static_cast<float>(p.y), z[i] = static_cast<float>(p.z);
    }
    seconds += processor_seconds([&] {
      evaluate_heights(noise, field.tables().arrays, kBatch, x.data(), y.data(), z.data(), height.data());
    });
  }
  fmt::print("heights of a relief on a ball: {:.1f} million points a second on one core\n",
             1e-6 * kBatch * kBatches / seconds);
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
  app.add_option("--steps", table.steps);
  CLI11_PARSE(app, argc, argv);
  {
    const ThreadLimit one(1);
    print_rate();
  }
  for (const std::string& file : files) print_rows(file, table);
  return 0;
}
