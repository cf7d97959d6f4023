#include "estimation/shape/fit/component_repair.h"

#include <algorithm>

#include "estimation/shape/fit/sphere_growth.h"
#include "estimation/shape/model/metaball_model.h"
#include "estimation/shape/packing/clearance_grid.h"

namespace astrolith {
namespace {

// The number of grid cells inside the target, and the least depth of a watched place (fraction of the
// diagonal). Nearer to the surface the samples and the shells of points beside it are dense enough.
constexpr double kWatchedCells = 30000.0;
constexpr double kWatchedDepth = 0.012;
// Bodies that are thin everywhere are watched from this share of their greatest depth on.
constexpr double kWatchedShare = 0.5;

// A level below this is low. Between two places of the grid the level can be lower by about as much.
constexpr double kLowLevel = 0.05;

// The radius of a metaball that fills a cavity: this multiple of the cavity's radius, or the least radius.
constexpr double kFillerScale = 1.1;
constexpr double kSmallestFiller = 0.003;  // fraction of the diagonal

std::size_t count_cavities(const std::vector<StrayComponent>& strays) {
  return static_cast<std::size_t>(
      std::count_if(strays.begin(), strays.end(), [](const StrayComponent& s) { return s.cavity; }));
}

// The metaballs to remove: subtractive or additive ones, in cavities or in islands.
struct Culprits {
  bool cavities, subtractive;
};

// Removes the culprits whose centre lies in a stray component. If no additive metaball would remain, nothing
// is removed.
void remove_within(MetaballModel& model, const std::vector<StrayComponent>& strays,
                   const Culprits& culprits) {
  const auto is_culprit = [&](const ModelSphere& s) {
    return s.subtractive == culprits.subtractive &&
           std::any_of(strays.begin(), strays.end(), [&](const StrayComponent& stray) {
             return stray.cavity == culprits.cavities && norm(s.center - stray.center) < stray.radius;
           });
  };
  std::vector<ModelSphere> kept;
  std::remove_copy_if(model.spheres.begin(), model.spheres.end(), std::back_inserter(kept), is_culprit);
  const auto additive = [](const ModelSphere& s) { return !s.subtractive; };
  if (std::any_of(kept.begin(), kept.end(), additive)) model.spheres = std::move(kept);
}

}  // namespace

InsideWatch::InsideWatch(const TargetBody& target) {
  const ClearanceGrid grid = make_clearance_grid(target.mesh, target.tree, kWatchedCells);
  const float deepest = *std::max_element(grid.clearance.begin(), grid.clearance.end());
  const double depth = std::min(kWatchedDepth, kWatchedShare * double{deepest});
  for (std::size_t i = 0; i < grid.clearance.size(); ++i) {
    if (double{grid.clearance[i]} > depth) places_.push_back(grid.center(i));
  }
}

void InsideWatch::add_dips(const MetaballModel& model, std::vector<Vec3d>& inside) {
  const std::vector<double> levels = model_levels(model, places_);
  std::vector<Vec3d> others;
  for (std::size_t i = 0; i < places_.size(); ++i) {
    (levels[i] < kLowLevel ? inside : others).push_back(places_[i]);
  }
  places_ = std::move(others);
}

void fill_cavities(MetaballModel& model, const std::vector<StrayComponent>& strays,
                   const std::vector<Vec3d>& on_surface) {
  remove_within(model, strays, {.cavities = true, .subtractive = true});
  const std::size_t before = model.spheres.size();
  const std::size_t wanted = std::min(count_cavities(strays), before - 1);
  remove_least_useful_spheres(model, on_surface, static_cast<int>(wanted));
  const std::size_t cavities = before - model.spheres.size();
  std::size_t filled = 0;
  for (const StrayComponent& stray : strays) {
    if (!stray.cavity || filled == cavities) continue;
    model.spheres.emplace_back(stray.center, std::max(kFillerScale * stray.radius, kSmallestFiller));
    ++filled;
  }
}

void remove_islands(MetaballModel& model, const std::vector<StrayComponent>& strays) {
  remove_within(model, strays, {.cavities = false, .subtractive = false});
}

}  // namespace astrolith
