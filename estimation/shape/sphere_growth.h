// Where a model needs more spheres and which it can do without: the adaptive half of the shape fit.
#pragma once

#include <span>
#include <vector>

#include "estimation/shape/metaball_model.h"
#include "estimation/shape/refinement.h"
#include "geometry/mesh_sampling.h"

namespace astrolith {

// First-order signed distance s of every point: positive inside the model.  (#points)
std::vector<double> model_distances(const MetaballModel& model, std::span<const Vec3d> points);

// Up to `count` spheres just under the surface where s^2, averaged over patches of the size that one sphere
// of `budget` has to itself, is largest; no two in one patch. Each starts as a slight bulge: the refinement
// decides what becomes of it. `samples` are even over the target's surface, `area` is its area.
std::vector<Sphere> spheres_for_largest_errors(const MetaballModel& model, const SurfaceSamples& samples,
                                               double area, int budget, int count);

// Removes the spheres that hold less than `share` of the kernel sum at every point given; returns how many.
// At least one sphere stays.
int remove_idle_spheres(MetaballModel& model, const FitPoints& points, double share);

// Removes the `count` spheres whose absence moves the surface least, summed over the points of it.
void remove_least_useful_spheres(MetaballModel& model, const std::vector<Vec3d>& on_surface, int count);

// Removes the spheres whose centre lies outside the target by more than `margin`; returns how many. The
// refinement pushes out what it cannot use, and there such a sphere is an island. At least one sphere stays.
int remove_outside_spheres(MetaballModel& model, const SurfaceTree& target, double margin);

}  // namespace astrolith
