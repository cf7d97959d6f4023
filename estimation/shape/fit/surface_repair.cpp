#include "estimation/shape/fit/surface_repair_internal.h"

#include <cstdlib>
#include <tuple>

#include "estimation/shape/fit/fit_check.h"
#include "geometry/mesh_topology.h"

namespace astrolith {
namespace {

// A vertex of the fit farther from the target than this is a stray (fraction of the diagonal).
constexpr double kStrayDistance = 0.015;
// Where the fit has a handle, vertices whose normals are not the target's are strays from here on.
constexpr double kTurnedDistance = 0.002;
constexpr int kRepairs = 4;
constexpr std::int64_t kRepairSamples = 20000;

struct MeasuredModel {
  MetaballModel model;
  ComponentComparison components;
  std::int64_t handles = 0;  // more than the target has, or fewer
  double mean_distance = 0.0;

  std::int64_t wrong() const { return components.wrong() + handles; }
  bool better_than(const MeasuredModel& other) const {
    const std::int64_t own = wrong(), others = other.wrong();
    return std::tie(own, mean_distance) < std::tie(others, other.mean_distance);
  }
};

// Adds the stray vertices to the containment points. Returns true if there are none.
bool collect_strays(const TargetBody& target, const FitCheck& check, bool handles, FitPoints& points) {
  const FitPoints strays =
      stray_points(target, check.mesh, kStrayDistance, handles ? kTurnedDistance : kStrayDistance);
  points.inside.insert(points.inside.end(), strays.inside.begin(), strays.inside.end());
  points.outside.insert(points.outside.end(), strays.outside.begin(), strays.outside.end());
  return strays.inside.empty() && strays.outside.empty();
}

void mend(const ComponentComparison& components, int spheres, const AdaptiveFitOptions& options,
          InsideWatch& watch, TrackedModel& fit) {
  remove_islands(fit.model(), components.strays);
  fill_cavities(fit.model(), components.strays, fit.points().on_surface);
  fit.grow(spheres, 1, fit.best_distance());
  watch.add_dips(fit.model(), fit.points().inside);
  fit.refine_beyond_plan(options.relocation_iterations);
}

}  // namespace

void repair_surface(const TargetBody& target, const AdaptiveFitOptions& options, InsideWatch& watch,
                    TrackedModel& fit) {
  const auto spheres = static_cast<int>(fit.model().spheres.size());
  const std::int64_t genus = analyze_topology(target.mesh).genus;
  MeasuredModel best;
  for (int repair = 0;; ++repair) {
    fit.remove_outside();
    const FitCheck check =
        check_fit(target, metaball_body(fit.model()), options.repair_resolution, kRepairSamples, 1);
    const MeasuredModel now{fit.model(), compare_components(target, check.mesh),
                            std::abs(check.topology.genus - genus), check.distance.mean};
    if (repair == 0 || now.better_than(best)) best = now;
    const bool complete = static_cast<int>(fit.model().spheres.size()) == spheres;
    const bool clean = collect_strays(target, check, now.handles > 0, fit.points()) && now.wrong() == 0;
    if ((clean && complete) || fit.interrupted() || repair == kRepairs) break;
    mend(now.components, spheres, options, watch, fit);
  }
  fit.model() = std::move(best.model);
}

}  // namespace astrolith
