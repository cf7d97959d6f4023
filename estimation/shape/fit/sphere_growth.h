// Adds metaballs to a model where its error is largest, and removes the ones that it does not need.
#pragma once

#include <vector>

#include "estimation/shape/model/metaball_model.h"
#include "estimation/shape/refinement/refinement.h"
#include "geometry/surface/mesh_sampling.h"

namespace astrolith {

struct GrowthOptions {
  double area = 0.0;    // area of the target's surface, > 0
  int budget = 0;       // metaballs in all, > 0; a patch has this share of the area
  int count = 0;        // new metaballs, at most
  int subtractive = 0;  // subtractive ones among the new metaballs, at most
};

// Returns new metaballs where s^2, averaged over patches of the surface, is largest. No two lie in one patch.
// Where the model lies under the target's surface, the new metaball lies below the surface and makes a bump.
// Where the model sticks out, it lies above the surface, is subtractive and makes a dent; it is additive if
// no more may be subtractive. The refinement that follows moves and scales the new metaballs. `samples` are
// spread evenly over the target's surface.
std::vector<ModelSphere> spheres_for_largest_errors(const MetaballModel& model, const SurfaceSamples& samples,
                                                    const GrowthOptions& options);

// The functions below keep at least one additive metaball: if none would remain, they remove nothing.

// Removes idle metaballs and returns how many. A metaball is idle if its removal moves the surface by less
// than `distance` at all points on the surface, and if it holds little of its kind's sum at all containment
// points: at the inside points for an additive metaball, at the outside points for a subtractive one.
int remove_idle_spheres(MetaballModel& model, const FitPoints& points, double distance);

// Removes the `count` metaballs whose removal moves the surface least, as the sum of squares over
// `on_surface`.
void remove_least_useful_spheres(MetaballModel& model, const std::vector<Vec3d>& on_surface, int count);

// Removes the additive metaballs whose centre lies outside the target by more than `margin`, and returns how
// many. The refinement moves metaballs that it cannot use out of the target, where they become islands.
int remove_outside_spheres(MetaballModel& model, const SurfaceTree& target, double margin);

}  // namespace astrolith
