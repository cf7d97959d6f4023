// Measures the power and the size of the test of realism (descriptor/surface/realism.h): which impostors it
// rejects, and how often it rejects a body that is sampled anew, a body with other triangles, and another
// draw of one recipe. Prints tables in Markdown (docs/descriptor.md).
//
//   realism_benchmark --seeds 3 MESH... RECIPE...
//
// A mesh is a closed body of some ten thousand triangles. Two draws of a recipe (.json) are its meshes with
// two seeds, of about 49,000 triangles each.
#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <cmath>
#include <filesystem>
#include <map>
#include <string>
#include <vector>

#include "descriptor/surface/realism.h"
#include "geometry/io/mesh_io.h"
#include "synthesis/field/field_mesh.h"
#include "tasks/synthesis/load_recipe.h"
#include "tests/benchmarks/impostors.h"
#include "tests/benchmarks/processor_seconds.h"

namespace {

using namespace astrolith;

struct Counts {
  int rejected_by_p = 0, failed = 0, cases = 0;
};
std::map<std::string, Counts> counts_of_kind;

std::string words_of(const RealismVerdict& verdict) {
  std::string all;
  for (const std::string& words : realism_words(verdict, {})) all += (all.empty() ? "" : "; ") + words;
  return all;
}

std::string bands_of(const RealismVerdict& verdict) {
  std::string all;
  for (const BandRatio& band : verdict.bands) all += fmt::format("{:.2f} ", band.ratio);
  return all;
}

SurfaceStatistics sampled(const TriangleMesh& mesh, std::int64_t points, std::uint64_t seed) {
  SurfaceStatisticsOptions options;
  options.points = points;
  options.seed = seed;
  return surface_statistics(mesh, options);
}

void judge(const std::string& body, const std::string& kind, const TriangleMesh& a, const TriangleMesh& b,
           std::uint64_t seed) {
  const std::int64_t points = common_points(a, b);
  const SurfaceStatistics of_a = sampled(a, points, 2 * seed), of_b = sampled(b, points, 2 * seed + 1);
  RealismOptions options;
  options.seed = seed;
  const RealismVerdict verdict = judge_realism(of_a, of_b, options);
  Counts& counts = counts_of_kind[kind];
  ++counts.cases;
  if (verdict.p < kPassingP) ++counts.rejected_by_p;
  if (!verdict.passes) ++counts.failed;
  const StatisticComparison* worst = verdict.farthest();
  fmt::print("| {} | {} | {} | {:.3f} | {:.3f} ({} {:g}) | {:.2f} | {}| {:.2f} | {} |\n", body, kind, seed,
             verdict.p, verdict.largest_distance, worst != nullptr ? name_of(worst->quantity) : "none",
             worst != nullptr ? worst->radius : 0.0, verdict.variance_ratio, bands_of(verdict),
             verdict.coupling_ratio.value_or(0.0), words_of(verdict));
  std::fflush(stdout);
}

void judge_body(const std::string& file, int seeds) {
  const TriangleMesh body = read_mesh(file);
  const std::string name = std::filesystem::path(file).stem().string();
  const double seconds = processor_seconds([&] { sampled(body, 0, 1); });
  fmt::print("| {} | measured in {:.2f} processor seconds | | | | | | | |\n", name, seconds);
  const auto triangles = static_cast<double>(body.triangles.size());
  const TriangleMesh other = remeshed(body, triangles), finer = remeshed(body, 2 * triangles),
                     smooth = laplace_impostor(body), half = relief_impostor(body, 0.5),
                     coarse = decimated_impostor(body), harmonics = harmonics_impostor(body);
  for (std::uint64_t seed = 1; seed <= static_cast<std::uint64_t>(seeds); ++seed) {
    judge(name, "itself, sampled anew", body, body, seed);
    judge(name, "itself, other triangles", body, other, seed);
    judge(name, "itself, twice the triangles", body, finer, seed);
    judge(name, "fractal noise", body, noise_impostor(body, seed), seed);
    judge(name, "half its relief", body, half, seed);
    judge(name, "one Laplace step", body, smooth, seed);
    judge(name, "decimated and refined", body, coarse, seed);
    judge(name, "harmonics of degree 30", body, harmonics, seed);
  }
}

TriangleMesh drawn(Recipe recipe, std::uint64_t seed) {
  constexpr double kTriangles = 49000;
  recipe.seed = seed;
  const ImplicitField field(recipe);
  const auto meshed = [&](int resolution) {
    MeshCollector collector;
    mesh_field(field, field.bounds(), resolution, collector);
    return std::move(collector.mesh);
  };
  constexpr int kFirst = 64;
  const auto triangles = static_cast<double>(meshed(kFirst).triangles.size());
  return meshed(static_cast<int>(std::lround(kFirst * std::sqrt(kTriangles / triangles))));
}

void judge_recipe(const std::string& file, int seeds) {
  const Recipe recipe = load_recipe(file);
  const std::string name = std::filesystem::path(file).stem().string();
  for (std::uint64_t seed = 1; seed <= static_cast<std::uint64_t>(seeds); ++seed) {
    judge(name, "two draws of a recipe", drawn(recipe, 100 + seed), drawn(recipe, 200 + seed), seed);
  }
}

}  // namespace

int main(int argc, char** argv) {
  CLI::App app{"Power and size of the test of realism."};
  std::vector<std::string> files;
  int seeds = 3;
  app.add_option("files", files, "meshes and recipes")->required();
  app.add_option("--seeds", seeds);
  CLI11_PARSE(app, argc, argv);
  fmt::print(
      "| body | case | seed | p | largest distance | variance ratio | bands | coupling | words "
      "|\n|---|---|---|---|---|---|---|---|---|\n");
  for (const std::string& file : files) {
    if (file.ends_with(".json")) {
      judge_recipe(file, seeds);
    } else {
      judge_body(file, seeds);
    }
  }
  fmt::print("\n| case | cases | rejected by p | fail |\n|---|---|---|---|\n");
  for (const auto& [kind, counts] : counts_of_kind) {
    fmt::print("| {} | {} | {} | {} |\n", kind, counts.cases, counts.rejected_by_p, counts.failed);
  }
}
