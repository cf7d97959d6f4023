#include "tasks/estimation/relief_mending.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <cstdlib>
#include <utility>
#include <vector>

#include "estimation/shape/relief/relief_fit.h"
#include "estimation/shape/target/surface_components.h"
#include "recipe/recipe_json.h"
#include "tasks/estimation/shape_recipe.h"

namespace astrolith {
namespace {

// The vertices of the fit's mesh that belong to stray components, are far from the target or turned away from
// it; in the file's frame.
std::vector<Vec3d> find_strays(const TargetBody& target, const FitCheck& check, double turned) {
  constexpr double kStrayDistance = 0.015;  // of the diagonal
  std::vector<Vec3d> strays;
  for (const StrayComponent& stray : compare_components(target, check.mesh).strays) {
    std::copy_if(check.mesh.vertices.begin(), check.mesh.vertices.end(), std::back_inserter(strays),
                 [&](const Vec3d& p) { return norm(p - stray.center) <= stray.radius * (1.0 + 1e-9); });
  }
  const FitPoints far = stray_points(target, check.mesh, kStrayDistance, turned);
  strays.insert(strays.end(), far.inside.begin(), far.inside.end());
  strays.insert(strays.end(), far.outside.begin(), far.outside.end());
  for (Vec3d& p : strays) p = target.center + target.diagonal * p;
  return strays;
}

// How many parts and handles a fit has too many or too few.
std::int64_t topology_mismatch(const ShapeFitResult& fit, const PartsAndHandles& wanted) {
  const PartsAndHandles made = parts_and_handles(fit.check.topology);
  return std::abs(made.parts - wanted.parts) + std::abs(made.handles - wanted.handles);
}

}  // namespace

std::size_t mend_relief(const TargetBody& target, const ShapeFitOptions& options, std::size_t most_bytes,
                        const Progress& progress, Recipe& recipe, ShapeFitResult& fit) {
  constexpr int kRounds = 8;
  const PartsAndHandles wanted = parts_and_handles(target);
  const std::int64_t mismatch = topology_mismatch(fit, wanted);
  if (mismatch == 0) return 0;
  const Recipe whole = recipe;
  const ShapeFitResult as_it_was = fit;
  double turned = 0.002;  // of the diagonal
  std::size_t halved = 0;
  for (int round = 0; round < kRounds && topology_mismatch(fit, wanted) > 0; ++round) {
    if (!report(progress, static_cast<double>(round) / kRounds, "topology")) break;
    Recipe softened = recipe;
    const std::size_t changed = halve_heights(find_strays(target, fit.check, turned), softened);
    if (changed == 0) break;
    if (most_bytes > 0 && recipe_to_compact(softened).size() > most_bytes) break;
    halved += changed;
    recipe = std::move(softened);
    measure_recipe(target, recipe, options, fit);
    turned *= 0.7;
  }
  if (topology_mismatch(fit, wanted) < mismatch) return halved;
  recipe = whole;  // lower heights have not helped
  fit = as_it_was;
  return 0;
}

}  // namespace astrolith
