// Gaussian curvature at points of a surface: of a mesh, or of points and normals alone.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "geometry/surface/mesh_sampling.h"
#include "geometry/triangle_mesh.h"

namespace astrolith {

struct SampleCurvature {
  std::vector<double> gaussian;  // (n) 1 / length^2; 0 where it is undefined
  std::int64_t undefined = 0;    // samples without a curvature
  std::int64_t vertices_left_out =
      0;  // of the mesh: boundary, non-manifold, ... (geometry/surface/curvature.h)
};

// At samples of the mesh, the mean of its vertices' curvature K_v (Meyer et al.) in a ball around the sample,
//   sum w_v A_v K_v / sum w_v A_v,   w_v = (1 - d_v^2 / r^2)^2,
// with their mixed areas A_v and distances d_v. A_v K_v is an integral of curvature, so the mean depends
// little on how finely the surface is triangulated, which K_v alone does on rough ground; w fades out because
// a sharp border would cut bumps in two. r is `radius`, or more where the sample's triangle has a corner
// farther away. Vertices whose normal looks away from the sample's lie on another side of a thin part and are
// not counted. radius >= 0 in the mesh's unit. Throws InputError for indices out of range.
SampleCurvature sample_curvature(const TriangleMesh& mesh, const SurfaceSamples& samples, double radius);

// Neighbours that a quadric is fitted to: somewhat more than two rings of evenly spread points.
inline constexpr int kCurvatureNeighbours = 24;

// From (n) points and (n) unit normals alone: z = a x^2 / 2 + b x y + c y^2 / 2 + d x + e y + f is fitted by
// least squares to the nearest points (the point itself among them) in the frame of the point's normal;
// K = (a c - b^2) / (1 + d^2 + e^2)^2. Neighbours whose normal looks away are left out. Undefined where the
// neighbours do not determine the six coefficients.
SampleCurvature point_curvature(std::span<const Vec3d> points, std::span<const Vec3d> normals,
                                int neighbours = kCurvatureNeighbours);

}  // namespace astrolith
