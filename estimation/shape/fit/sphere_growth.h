// Where a model needs more spheres and which it can do without: the adaptive half of the shape fit.
#pragma once

#include <span>
#include <vector>

#include "estimation/shape/model/metaball_model.h"
#include "estimation/shape/refinement/refinement.h"
#include "geometry/surface/mesh_sampling.h"

namespace astrolith {

// First-order signed distance s of every point: positive inside the model.  (#points)
std::vector<double> model_distances(const MetaballModel& model, std::span<const Vec3d> points);

struct GrowthOptions {
  double area = 0.0;    // of the target's surface
  int budget = 0;       // spheres in all: each of them has a patch of the surface to itself
  int count = 0;        // new spheres at most
  int subtractive = 0;  // of them that may take away, at most
};

// Spheres where s^2, averaged over patches, is largest; no two in one patch. Where the model lies under the
// target's surface, a sphere just below it that starts as a slight bulge; where the model sticks out, one
// just above that takes away and starts as a slight dent. The refinement decides what becomes of them.
// `samples` are even over the target's surface.
std::vector<ModelSphere> spheres_for_largest_errors(const MetaballModel& model, const SurfaceSamples& samples,
                                                    const GrowthOptions& options);

// Removes the spheres without which the surface moves less than `distance` at all of its points, and that
// hold little of their kind's sum at the points inside, or outside where they take away; returns how many. At
// least one sphere that adds stays, here and below.
int remove_idle_spheres(MetaballModel& model, const FitPoints& points, double distance);

// Removes the `count` spheres whose absence moves the surface least, summed over the points of it.
void remove_least_useful_spheres(MetaballModel& model, const std::vector<Vec3d>& on_surface, int count);

// Removes the spheres that add and whose centre lies outside the target by more than `margin`; returns how
// many. The refinement pushes out what it cannot use, and there such a sphere is an island.
int remove_outside_spheres(MetaballModel& model, const SurfaceTree& target, double margin);

}  // namespace astrolith
