// Keeps the connected components of a fit's surface to those of its target. Samples of the target's surface
// do not constrain the model away from the surface, so islands and cavities can form there.
#pragma once

#include <vector>

#include "estimation/shape/model/metaball_model.h"
#include "estimation/shape/refinement/refinement.h"
#include "estimation/shape/target/surface_components.h"
#include "estimation/shape/target/target_body.h"

namespace astrolith {

// Watches the inside of the target on a grid. The fit moves metaballs towards the surface, and the level
// sinks between them. A cavity opens where the level falls below 0.
class InsideWatch {
 public:
  explicit InsideWatch(const TargetBody& target);

  // Adds to `inside` the places where the model's level is low. A place is added at most once in all calls.
  void add_dips(const MetaballModel& model, std::vector<Vec3d>& inside);

 private:
  std::vector<Vec3d> places_;  // not yet added
};

// Removes the subtractive metaballs whose centre lies in a cavity, and puts an additive one in place of each
// cavity. The number of metaballs does not grow: the least useful ones at `on_surface`, points of the
// target's surface, are removed to make room.
void fill_cavities(MetaballModel& model, const std::vector<StrayComponent>& strays,
                   const std::vector<Vec3d>& on_surface);

// Removes the additive metaballs whose centre lies in an island. The model keeps at least one additive
// metaball: if none would remain, nothing is removed.
void remove_islands(MetaballModel& model, const std::vector<StrayComponent>& strays);

}  // namespace astrolith
