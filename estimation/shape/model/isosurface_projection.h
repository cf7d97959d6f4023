// Points of space brought onto a metaball model's surface along its gradient: a sampling of the surface
// without meshing it.
#pragma once

#include <span>

#include "estimation/shape/model/metaball_model.h"
#include "geometry/surface/mesh_sampling.h"

namespace astrolith {

// Newton steps p <- p + s(p) n, n = -grad L / |grad L|, each no longer than the largest radius. Normals point
// out of the body. Points that no sphere reaches stay where they are, with a normal away from the nearest
// sphere.  (#points in, #points out)
SurfaceSamples project_onto_isosurface(const MetaballModel& model, std::span<const Vec3d> points,
                                       int steps = 4);

}  // namespace astrolith
