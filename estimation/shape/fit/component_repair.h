// What keeps a fit's surface to the parts of its target: samples of the target's surface say nothing of what
// the model does away from it.
#pragma once

#include <vector>

#include "estimation/shape/model/metaball_model.h"
#include "estimation/shape/refinement/refinement.h"
#include "estimation/shape/target/surface_components.h"
#include "estimation/shape/target/target_body.h"

namespace astrolith {

// Watches the inside of the target on a grid: where spheres are moved towards the surface, as the fit does,
// the level sinks between them, and where it passes 0 a cavity opens.
class InsideWatch {
 public:
  explicit InsideWatch(const TargetBody& target);

  // Adds to `inside` the places where the model's level is low, each place once.
  void add_dips(const MetaballModel& model, std::vector<Vec3d>& inside);

 private:
  std::vector<Vec3d> places_;
};

// Removes the spheres that take away and have their centre in a cavity, and puts one that adds in place of
// each cavity: no more spheres than before, for the least useful of them go, as seen from points on the
// surface. A filled cavity is gone whatever other spheres that add do there.
void fill_cavities(MetaballModel& model, const std::vector<StrayPart>& strays,
                   const std::vector<Vec3d>& on_surface);

// Removes the spheres that make the islands among the strays. At least one that adds stays.
void remove_islands(MetaballModel& model, const std::vector<StrayPart>& strays);

}  // namespace astrolith
