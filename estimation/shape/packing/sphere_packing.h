// Greedy polydisperse packing of a closed body with spheres that lie inside and do not overlap, largest first
// (thesis section 4.3.2, algorithm 3; Weller and Zachmann, "Protosphere", 2010).
//
// Where the paper lets random prototypes climb to the Voronoi nodes of the surface and the spheres placed so
// far, a grid holds the clearance of every place (estimation/shape/packing/clearance_grid.h). The place of
// largest clearance climbs to its node by exact distances, away from the nearest obstacle with steps that
// grow shorter; the sphere there is placed and the grid lowered around it. Nothing is random.
#pragma once

#include <cstdint>
#include <vector>

#include "geometry/surface/surface_tree.h"
#include "geometry/triangle_mesh.h"
#include "numerics/progress.h"
#include "recipe/recipe.h"

namespace astrolith {

struct PackingOptions {
  int max_spheres = 200;          // > 0
  double smallest_radius = 1e-4;  // as a fraction of the bounding-box diagonal, > 0
};

struct Packing {
  std::vector<Sphere> spheres;  // largest first
  double filling_rate = 0.0;    // volume of the spheres over that of the body
  bool interrupted = false;
};

// `body` is closed with positive volume and `tree` was made of it. The result does not depend on the number
// of threads. Fewer than max_spheres come back when no place of smallest_radius is left, or none that the
// grid can see: its cells are about a seventh of the mean diameter wide, for bodies in very large boxes
// wider.
Packing pack_spheres(const TriangleMesh& body, const SurfaceTree& tree, const PackingOptions& options,
                     const Progress& progress = {});

}  // namespace astrolith
