// The distance between two surfaces, measured at random points of both.
#pragma once

#include <cstdint>

#include "geometry/surface/surface_tree.h"
#include "geometry/triangle_mesh.h"
#include "numerics/progress.h"

namespace astrolith {

// Statistics of the distances from points of one surface to the other surface, in the unit of the meshes.
struct DistanceFigures {
  double mean = 0;
  double p99 = 0;  // 99 of 100 samples lie at most this far from the other surface
  double max = 0;
};

struct SurfaceDistanceReport {
  double mean = 0, p99 = 0, max = 0;  // over the samples of both directions together
  DistanceFigures from_a_to_b, from_b_to_a;
};

// Measures from `samples` > 0 area-weighted points on each mesh. `max` is a lower bound of the Hausdorff
// distance. Throws InputError when samples <= 0 and where SurfaceTree and sample_surface do, and WorkError
// when progress asks to stop.
SurfaceDistanceReport surface_distance(const TriangleMesh& a, const TriangleMesh& b, std::int64_t samples,
                                       std::uint64_t seed, const Progress& progress = {});

// The distance between two meshes whose trees have been built before.
SurfaceDistanceReport surface_distance(const TriangleMesh& a, const SurfaceTree& tree_a,
                                       const TriangleMesh& b, const SurfaceTree& tree_b, std::int64_t samples,
                                       std::uint64_t seed, const Progress& progress = {});

}  // namespace astrolith
