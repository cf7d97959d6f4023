// Moves points onto a metaball model's surface along its gradient. This samples the surface without meshing
// it.
#pragma once

#include <span>

#include "estimation/shape/model/metaball_model.h"
#include "geometry/surface/mesh_sampling.h"

namespace astrolith {

// Takes Newton steps p <- p + s(p) n with n = -grad L / |grad L|. No step is longer than the largest radius.
// The normals have length 1 and point out of the body. A point that no sphere reaches stays where it is, and
// its normal points away from the nearest sphere.  (#points in, #points out)
SurfaceSamples project_onto_isosurface(const MetaballModel& model, std::span<const Vec3d> points,
                                       int steps = 4);

}  // namespace astrolith
