// Greedy polydisperse packing of a closed body with spheres that lie inside and do not overlap, largest first
// (thesis section 4.3.2, algorithm 3; Weller and Zachmann, "Protosphere", 2010).
//
// Prototypes, random points inside, climb to Voronoi nodes of the surface and the spheres placed so far: away
// from the nearest of them, p += eps (p - q_c), with eps attenuated as they go. The prototype of largest
// clearance becomes the next sphere. Departure from the paper: a prototype climbs again only when it reaches
// the head of the queue with an overtaken clearance (clearances only shrink as spheres are placed), so that
// most of them rest.
#pragma once

#include <cstdint>
#include <vector>

#include "geometry/surface_tree.h"
#include "geometry/triangle_mesh.h"
#include "numerics/progress.h"
#include "recipe/recipe.h"

namespace astrolith {

struct PackingOptions {
  int max_spheres = 200;          // > 0
  int prototypes_per_sphere = 5;  // > 0
  int climb_steps = 30;           // of one prototype, > 0
  double smallest_radius = 1e-4;  // as a fraction of the bounding-box diagonal, > 0
  std::uint64_t seed = 1;
};

struct Packing {
  std::vector<Sphere> spheres;  // largest first
  double filling_rate = 0.0;    // volume of the spheres over that of the body
  bool interrupted = false;
};

// `body` is closed with positive volume and `tree` was made of it. The result does not depend on the number
// of threads. Fewer than max_spheres come back when none of smallest_radius fits any more.
Packing pack_spheres(const TriangleMesh& body, const SurfaceTree& tree, const PackingOptions& options,
                     const Progress& progress = {});

}  // namespace astrolith
