// Measures a fitted body: synthesis makes a mesh of it, which is compared with the target.
// Also the containment points of a base fit, inside and outside of the target.
#pragma once

#include <cstdint>
#include <vector>

#include "estimation/shape/target/target_body.h"
#include "geometry/mesh_topology.h"
#include "geometry/surface/surface_distance.h"
#include "recipe/recipe.h"

namespace astrolith {

struct ContainmentOptions {
  double deepest = 0.5;      // radius of the largest sphere inside the target, fraction of the diagonal, > 0
  std::int64_t samples = 0;  // surface samples of the fit, which scale the number of points, >= 0
  std::uint64_t seed = 1;    // of points anywhere in the box
  std::uint64_t shell_seed = 2;  // of points beside the surface
};

// Points at least 0.015 of the diagonal from the surface, shells of points beside it at 0.008, 0.016 and
// 0.032, and points in the middle of parts that are thinner than the first shell is deep. A body that is thin
// everywhere has its deep points at half of its greatest depth.
FitPoints containment_points(const TargetBody& target, const ContainmentOptions& options);

struct FitCheck {
  TriangleMesh mesh;               // the fitted body, in the target's frame
  MeshTopology topology;           // topology of `mesh`
  SurfaceDistanceReport distance;  // fractions of the target's bounding-box diagonal
  double volume_ratio = 0.0;       // the fitted body's volume over the target's
};

// Measures a mesh of a fit, in the target's frame, from `samples` fresh points of each surface.
FitCheck check_mesh(const TargetBody& target, TriangleMesh mesh, std::int64_t samples, std::uint64_t seed);

// Meshes the body with `resolution` cells along its longest side, and measures it as above. The body is in
// the target's frame.
FitCheck check_fit(const TargetBody& target, const MetaballBody& body, int resolution, std::int64_t samples,
                   std::uint64_t seed);

// Returns the vertices of the mesh that are farther than `threshold` from the target's surface, or farther
// than `turned` with a normal that is not the target's there. They belong to cavities, islands, bridges and
// tunnels, which no sample of the target constrains. Vertices inside the target become points that must lie
// inside the model, and vertices outside become points that must lie outside.
FitPoints stray_points(const TargetBody& target, const TriangleMesh& mesh, double threshold, double turned);

}  // namespace astrolith
