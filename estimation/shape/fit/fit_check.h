// How good a fitted body is: the mesh that synthesis makes of it, measured against the target.
#pragma once

#include <cstdint>
#include <vector>

#include "estimation/shape/target/target_body.h"
#include "geometry/mesh_topology.h"
#include "geometry/surface/surface_distance.h"
#include "recipe/recipe.h"

namespace astrolith {

struct FitCheck {
  TriangleMesh mesh;               // of the fitted body, in the target's frame
  MeshTopology topology;           // of mesh
  SurfaceDistanceReport distance;  // fractions of the target's bounding-box diagonal
  double volume_ratio = 0.0;       // of the fitted body's volume over the target's
};

// Meshes the body (in the target's frame) with `resolution` cells along its longest side, and measures from
// `samples` fresh points of both surfaces.
FitCheck check_fit(const TargetBody& target, const MetaballBody& body, int resolution, std::int64_t samples,
                   std::uint64_t seed);

// Vertices of the check's mesh further than `threshold` from the target: parts of the surface that no sample
// of the target asked for (cavities, islands, bridges). Those inside the target and those outside are told
// apart as the fit's containment points.
FitPoints stray_points(const TargetBody& target, const TriangleMesh& mesh, double threshold);

}  // namespace astrolith
