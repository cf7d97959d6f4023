// Gaussian and mean curvature at the vertices of a triangle mesh, and Gaussian curvature at points of a
// surface that is given as a mesh, or as points and normals alone.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "geometry/surface/mesh_sampling.h"
#include "geometry/triangle_mesh.h"
#include "numerics/progress.h"

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

struct SampleCurvature {
  std::vector<double> gaussian;  // (n) 1 / length^2; 0 where it is undefined
  std::int64_t undefined = 0;    // samples without a curvature
  // Vertices of the mesh without a curvature (VertexCurvature::left_out).
  std::int64_t vertices_left_out = 0;
};

// The curvature at each sample is a weighted mean of the curvatures K_v (Meyer et al.) of the mesh's vertices
// in a ball of radius r around the sample,
//   sum w_v A_v K_v / sum w_v A_v,   w_v = (1 - d_v^2 / r^2)^2,
// with the vertices' mixed areas A_v and their distances d_v. A_v K_v is an integral of curvature. The mean
// therefore depends little on how finely the surface is triangulated, which K_v alone does on rough ground.
// w_v falls to 0 smoothly, since a sharp border would cut bumps in two. r is `radius`, or more where the
// sample's triangle has a corner farther away. A vertex whose normal looks away from the sample's normal lies
// on another side of a thin body and is not counted. radius >= 0 in the unit of the mesh. Throws InputError
// for indices out of range, and WorkError when progress asks to stop.
SampleCurvature sample_curvature(const TriangleMesh& mesh, const SurfaceSamples& samples, double radius,
                                 const Progress& progress = {});

// The number of neighbours that a quadric is fitted to: somewhat more than two rings of evenly spread points.
inline constexpr int kCurvatureNeighbours = 24;

// The curvature from (n) points and (n) unit normals alone. The quadric z = a x^2 / 2 + b x y + c y^2 / 2 + d
// x + e y + f is fitted by least squares to the nearest points, the point itself among them, in the frame of
// the point's normal; K = (a c - b^2) / (1 + d^2 + e^2)^2. Neighbours whose normal looks away are left out. K
// is undefined where the neighbours do not determine the six coefficients. Throws WorkError when progress
// asks to stop.
SampleCurvature point_curvature(std::span<const Vec3d> points, std::span<const Vec3d> normals,
                                int neighbours = kCurvatureNeighbours, const Progress& progress = {});

}  // namespace astrolith
