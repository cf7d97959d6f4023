#include "estimation/shape/details/realism_check.h"

#include <algorithm>
#include <cmath>

#include "estimation/shape/target/surface_components.h"
#include "numerics/reported_loop.h"
#include "synthesis/field/field_mesh.h"
#include "synthesis/field/implicit_field.h"

namespace astrolith {
namespace {

constexpr double kMostMeshTriangles = 240000;

// Other noise for k > 0, which `synth --seed` makes again.
Recipe with_noise_seed(Recipe recipe, std::uint64_t k) {
  recipe.seed += k;
  return recipe;
}

// A share of the whole work, for one of its parts.
Progress part_progress(const Progress& progress, double begin, double end) {
  if (!progress) return {};
  return [=](double fraction, std::string_view words) {
    return progress(begin + (end - begin) * fraction, words);
  };
}

// The mesh of a recipe in the target's frame, with about so many triangles.
TriangleMesh mesh_with_triangles(const TargetBody& target, const Recipe& recipe, double triangles,
                                 const Progress& progress) {
  constexpr int kFirst = 64, kLeast = 16, kMost = 1024;
  const ImplicitField field(recipe);
  const auto meshed = [&](int resolution) {
    MeshCollector collector;
    mesh_field(field, field.bounds(), resolution, collector, at_beginning(progress));
    return std::move(collector.mesh);
  };
  const auto first_triangles = static_cast<double>(std::max<std::size_t>(meshed(kFirst).triangles.size(), 1));
  TriangleMesh mesh = meshed(std::clamp(
      static_cast<int>(std::lround(kFirst * std::sqrt(triangles / first_triangles))), kLeast, kMost));
  for (Vec3d& p : mesh.vertices) p = (p - target.center) * (1.0 / target.diagonal);
  return mesh;
}

}  // namespace

FitRealism check_realism(const TargetBody& target, const Recipe& recipe, int seeds, std::uint64_t seed,
                         const Progress& progress) {
  const int draws = recipe.layers.empty() ? 1 : seeds;
  const double triangles =
      std::min(2.0 * static_cast<double>(target.surface.triangles.size()), kMostMeshTriangles);
  SurfaceStatisticsOptions options;
  options.seed = seed;
  options.points = own_points(target.surface);
  const auto part = [&](double step) {
    const double steps = draws + 1.0;
    return part_progress(progress, step / steps, (step + 1.0) / steps);
  };
  FitRealism result;
  result.target = surface_statistics(target.surface, options, part(0));
  for (int k = 0; k < draws; ++k) {
    const auto which = static_cast<std::uint64_t>(k);
    TriangleMesh mesh = mesh_with_triangles(target, with_noise_seed(recipe, which), triangles, part(k + 1.0));
    options.seed = seed + 3 * (which + 1);
    SurfaceStatistics fit = surface_statistics(mesh, options, part(k + 1.0));
    result.seed_verdicts.push_back(
        judge_realism(result.target, fit, {.permutations = 999, .seed = seed}, part(k + 1.0)));
    if (k > 0) continue;
    result.mesh = std::move(mesh);
    result.fit = std::move(fit);
  }
  result.verdict = median_verdict(result.seed_verdicts);
  const PartsAndHandles wanted = parts_and_handles(target),
                        made = parts_and_handles(analyze_topology(result.mesh));
  if (made != wanted) {
    result.verdict.passes = false;
    result.verdict.other_topology = "has " + made.words() + ", the target " + wanted.words();
  }
  return result;
}

}  // namespace astrolith
