// The base fit beside spherical harmonics and beside a decimated mesh of as many bytes: mean distance from
// fresh samples of both surfaces, in percent of the bounding-box diagonal.
//
//   shape_peers_benchmark --spheres 200 MESH...
//
// A fit of n metaballs holds 4 n + 1 numbers: 200 stand against degree 27 (784), 1000 against degree 62
// (3969). Bytes are those of the recipe as written (JSON text, provenance left out) and of a binary PLY file
// (12 a vertex, 13 a triangle, its header left out).
#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <filesystem>

#include "estimation/shape/shape_fit.h"
#include "geometry/mesh_io.h"
#include "geometry/mesh_measure.h"
#include "geometry/mesh_sampling.h"
#include "recipe/recipe_json.h"
#include "tests/benchmarks/decimated_mesh.h"
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

void print(const char* what, std::size_t numbers, double bytes, const SurfaceDistanceReport& d) {
  fmt::print("  {:32}{:9}{:10.0f}{:10.4f}{:9.3f}{:9.3f}\n", what, numbers, bytes, 100 * d.mean, 100 * d.p99,
             100 * d.max);
  std::fflush(stdout);
}

void compare_peers(const std::string& file, const ShapeFitOptions& options, const std::vector<int>& degrees) {
  const TargetBody target = prepare_target(read_mesh(file), file);
  fmt::print("{}\n", std::filesystem::path(file).stem().string());
  const MetaballBody body = fit_shape(target, options).body;
  MetaballBody moved = body;
  for (Sphere& s : moved.spheres) {
    s = {(s.center - target.center) * (1.0 / target.diagonal), s.radius / target.diagonal};
  }
  const auto bytes = static_cast<double>(recipe_bytes(body));
  print("metaballs", 4 * body.spheres.size() + 1, bytes,
        check_fit(target, moved, options.check_resolution, kSamples, 99).distance);
  const TriangleMesh fewer = decimated(target.mesh, static_cast<std::size_t>(bytes / kBytesPerVertex));
  print(
      "decimated mesh of equal bytes", 3 * fewer.vertices.size(),
      12.0 * static_cast<double>(fewer.vertices.size()) + 13.0 * static_cast<double>(fewer.triangles.size()),
      distance(target, fewer));
  for (const int degree : degrees) {
    const auto count = static_cast<std::size_t>((degree + 1) * (degree + 1));
    print(fmt::format("spherical harmonics, degree {}", degree).c_str(), count,
          4.0 * static_cast<double>(count), harmonics_distance(target, degree));
  }
}

}  // namespace

int main(int argc, char** argv) {
  CLI::App app{"The base fit beside spherical harmonics and decimated meshes."};
  std::vector<std::string> files;
  std::vector<int> degrees{27};
  ShapeFitOptions options;
  app.add_option("meshes", files)->required();
  app.add_option("--spheres", options.spheres);
  app.add_option("--seed", options.seed);
  app.add_option("--degree", degrees, "of the harmonics; may be given more than once");
  CLI11_PARSE(app, argc, argv);
  fmt::print("{:34}{:>9}{:>10}{:>10}{:>9}{:>9}\n", "", "numbers", "bytes", "mean %", "p99 %", "max %");
  for (const std::string& file : files) compare_peers(file, options, degrees);
}
