// Gaussian and mean curvature at the vertices of a triangle mesh.
#pragma once

#include <cstdint>
#include <vector>

#include "geometry/triangle_mesh.h"

namespace astrolith {

struct VertexCurvature {
  std::vector<double> gaussian;  // (#V) 1 / length^2; 1 / r^2 on a sphere
  std::vector<double> mean;      // (#V) 1 / length; positive where convex: 1 / r on a sphere
  std::vector<double> area;      // (#V) mixed area of each vertex, length^2; sums to the area of the surface
  // Vertices without a full ring of consistently oriented triangles (boundary, non-manifold, misoriented,
  // unused) and vertices of a triangle without area, in ascending order. Their three values are 0.
  std::vector<std::uint32_t> left_out;
};

// Curvatures by Meyer, Desbrun, Schroeder and Barr, "Discrete differential-geometry operators for
// triangulated 2-manifolds", VisMath 2003: eq. 9 (Gaussian), eq. 8 and 5 (mean), figure 4 (mixed area). On a
// closed manifold the sum of gaussian * area is 2 pi times the Euler characteristic. Throws InputError for
// indices out of range.
VertexCurvature vertex_curvature(const TriangleMesh& mesh);

}  // namespace astrolith
