// Compares the base fit with spherical harmonics and with a decimated mesh of as many bytes: distances at
// fresh samples of both surfaces, in percent of the bounding-box diagonal, as a table in Markdown
// (docs/accuracy_shapes.md).
//
//   shape_peers_benchmark --spheres 200 --degree 27 MESH...
//
// A fit of n metaballs holds 4 n + 1 numbers: 200 metaballs stand against degree 27 (784 numbers), 1000
// against degree 62 (3969). Bytes are those of the recipe as written (JSON text without provenance) and of a
// binary PLY file (12 for each vertex, 13 for each triangle, without its header). The table gives components
// and genus of the fit over those of the target.
#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <filesystem>

#include "estimation/shape/fit/shape_fit.h"
#include "geometry/io/mesh_io.h"
#include "geometry/mesh_measure.h"
#include "geometry/mesh_topology.h"
#include "geometry/surface/decimated_mesh.h"
#include "geometry/surface/mesh_sampling.h"
#include "recipe/recipe_json.h"
#include "tests/benchmarks/processor_seconds.h"
#include "tests/benchmarks/spherical_harmonics.h"

namespace {

using namespace astrolith;

constexpr std::int64_t kSamples = 100000;
constexpr std::size_t kSamplesPerCoefficient = 12;
constexpr double kBytesPerVertex = 12.0 + 2.0 * 13.0;  // a closed mesh has twice as many triangles

SurfaceDistanceReport distance(const TargetBody& target, const TriangleMesh& mesh) {
  return surface_distance(target.surface, target.tree, mesh, SurfaceTree(mesh), kSamples, 99);
}

SurfaceDistanceReport harmonics_distance(const TargetBody& target, int degree) {
  const auto count = static_cast<std::size_t>((degree + 1) * (degree + 1));
  const auto samples = static_cast<std::int64_t>(kSamplesPerCoefficient * count);
  const std::vector<Vec3d> points = sample_surface(target.surface, samples, 7).points;
  return distance(target, harmonics_mesh(fit_harmonics(points, volume_centroid(target.mesh), degree)));
}

std::size_t recipe_bytes(const MetaballBody& body) {
  Recipe recipe;
  recipe.body = body;
  return recipe_to_json(recipe).size();
}

TriangleMesh equal_bytes_mesh(const TargetBody& target, const MetaballBody& body) {
  const auto bytes = static_cast<double>(recipe_bytes(body));
  return decimated(target.mesh, static_cast<std::size_t>(bytes / kBytesPerVertex));
}

std::string percent(const SurfaceDistanceReport& d) {
  return fmt::format("{:.4f} / {:.3f}", 100 * d.mean, 100 * d.p99);
}

void print_row(const std::string& file, const ShapeFitOptions& options, int degree) {
  const TargetBody target = prepare_target(read_mesh(file), file);
  ShapeFitResult fit;
  const double seconds = processor_seconds([&] { fit = fit_shape(target, options); });
  const MeshTopology& topology = fit.check.topology;
  fmt::print("| {} | {} | {} | {} | {} / {} | {} / {} | {} | {:.0f} |\n",
             std::filesystem::path(file).stem().string(), percent(fit.check.distance),
             percent(harmonics_distance(target, degree)),
             percent(distance(target, equal_bytes_mesh(target, fit.body))), topology.components,
             target.components, topology.genus, analyze_topology(target.mesh).genus,
             fmt::format("{:.2f}", fit.body.blend_exponent * fit.body.a), seconds);
  std::fflush(stdout);
}

}  // namespace

int main(int argc, char** argv) {
  CLI::App app{"The base fit beside spherical harmonics and decimated meshes."};
  std::vector<std::string> files;
  int degree = 27;
  ShapeFitOptions options;
  app.add_option("meshes", files)->required();
  app.add_option("--spheres", options.spheres);
  app.add_option("--seed", options.seed);
  app.add_option("--degree", degree, "of the harmonics");
  CLI11_PARSE(app, argc, argv);
  fmt::print(
      "| body | {} metaballs, mean / p99 % | harmonics of degree {} | decimated mesh | parts | genus | "
      "sharpness | CPU s |\n|---|---|---|---|---|---|---|---|\n",
      options.spheres, degree);
  for (const std::string& file : files) print_row(file, options, degree);
}
