#include "estimation/shape/fit/component_repair.h"

#include <algorithm>

#include "estimation/shape/fit/sphere_growth.h"
#include "estimation/shape/model/model_evaluation_internal.h"
#include "estimation/shape/packing/clearance_grid.h"

namespace astrolith {
namespace {

// Cells of the grid inside the target, and how deep its places lie (fraction of the diagonal): nearer to the
// surface its samples, and the shells of points beside it, are dense enough.
constexpr double kWatchedCells = 30000.0;
constexpr double kWatchedDepth = 0.012;

// Levels below this are low. Between places of the grid the level can sink that much again.
constexpr double kLowLevel = 0.05;

// A filler reaches this much further than what it fills, and is at least this large (fraction of the
// diagonal).
constexpr double kFillerScale = 1.1;
constexpr double kSmallestFiller = 0.003;

std::size_t count_cavities(const std::vector<StrayPart>& strays) {
  return static_cast<std::size_t>(
      std::count_if(strays.begin(), strays.end(), [](const StrayPart& s) { return s.cavity; }));
}

// Which spheres, in which strays.
struct Culprits {
  bool cavities, subtractive;
};

// Those whose centre is in such a stray. At least one that adds stays.
void remove_within(MetaballModel& model, const std::vector<StrayPart>& strays, const Culprits& culprits) {
  const auto is_culprit = [&](const ModelSphere& s) {
    return s.subtractive == culprits.subtractive &&
           std::any_of(strays.begin(), strays.end(), [&](const StrayPart& stray) {
             return stray.cavity == culprits.cavities && norm(s.center - stray.center) < stray.radius;
           });
  };
  std::vector<ModelSphere> kept;
  std::remove_copy_if(model.spheres.begin(), model.spheres.end(), std::back_inserter(kept), is_culprit);
  const auto adds = [](const ModelSphere& s) { return !s.subtractive; };
  if (std::any_of(kept.begin(), kept.end(), adds)) model.spheres = std::move(kept);
}

}  // namespace

InsideWatch::InsideWatch(const TargetBody& target) {
  const ClearanceGrid grid = make_clearance_grid(target.mesh, target.tree, kWatchedCells);
  for (std::size_t i = 0; i < grid.clearance.size(); ++i) {
    if (double{grid.clearance[i]} > kWatchedDepth) places_.push_back(grid.center(i));
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

void fill_cavities(MetaballModel& model, const std::vector<StrayPart>& strays,
                   const std::vector<Vec3d>& on_surface) {
  remove_within(model, strays, {.cavities = true, .subtractive = true});
  const std::size_t before = model.spheres.size();
  const std::size_t wanted = std::min(count_cavities(strays), before - 1);
  remove_least_useful_spheres(model, on_surface, static_cast<int>(wanted));
  const std::size_t cavities = before - model.spheres.size();
  std::size_t filled = 0;
  for (const StrayPart& stray : strays) {
    if (!stray.cavity || filled == cavities) continue;
    model.spheres.emplace_back(stray.center, std::max(kFillerScale * stray.radius, kSmallestFiller));
    ++filled;
  }
}

void remove_islands(MetaballModel& model, const std::vector<StrayPart>& strays) {
  remove_within(model, strays, {.cavities = false, .subtractive = false});
}

}  // namespace astrolith
