// Evenly spread points of a surface at one resolution, so that a triangulation is not mistaken for a surface.
#pragma once

#include <cstdint>
#include <vector>

#include "geometry/triangle_mesh.h"
#include "numerics/progress.h"

namespace astrolith {

struct EvenedSurface {
  std::vector<Vec3d> points;   // (n) the unit of the mesh
  std::vector<Vec3d> normals;  // (n) unit, outwards
  double area = 0.0;           // of the mesh
  double edge =
      0.0;  // of equilateral triangles with n vertices that cover the area: 2 area = sqrt(3) n edge^2
};

// The edge of n points that are spread evenly over an area.
double evened_edge(double area, std::int64_t n);

// Spreads n points as a Poisson disk over the mesh. Each point then moves along its normal to the weighted
// mean height of the surface around it, with weights (1 - d^2 / (2.5 edge)^2)^3. The weights are near those
// of a Gaussian of deviation 1 edge: waves of 4 edges keep .29 of their height, waves of 12 edges .87. A
// finer triangulation therefore adds nothing that a mesh of n vertices cannot have. Normals are weighted
// means of the normals of facets. Facets that look away from the point's own normal lie on another side of a
// thin body and do not count. Random places on the mesh, 8 a point, stand for the surface. Throws InputError
// as sample_surface() does, and WorkError when progress asks to stop.
EvenedSurface even_surface(const TriangleMesh& mesh, std::int64_t n, std::uint64_t seed,
                           const Progress& progress = {});

}  // namespace astrolith
