// shapeDNA: the first eigenvalues of a surface's Laplace-Beltrami operator, the tones it would sound as a
// drum.
//
// Reuter, Wolter and Peinecke, "Laplace-Beltrami spectra as 'Shape-DNA' of surfaces and solids",
// Computer-Aided Design 2006. They use cubic elements; here the linear ones, L x = lambda M x with the
// cotangent stiffness L and the lumped mass M (a third of each triangle's area to each corner). The spectrum
// does not change when a surface is moved, turned or bent without stretching; multiplied with the area it
// does not change with the scale either.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "geometry/triangle_mesh.h"

namespace astrolith {

struct LaplacianSpectrum {
  std::vector<double> eigenvalues;      // (count) ascending, times the area, so without a unit; >= 0
  double area = 0;                      // in the squared unit of the coordinates
  std::int64_t left_out_triangles = 0;  // without area: they have no cotangents
};

// The lowest count eigenvalues after the first, which is 0. Every further component adds one more 0. On a
// sphere they come near l (l + 1) 4 pi, 2 l + 1 times each. A boundary is free (Neumann's condition); which
// way faces are wound does not matter. Throws InputError for edges of three or more triangles, for a mesh
// without area, for more than 500,000 vertices, and when count is below 1 or the vertices are too few;
// WorkError should the eigensolver not converge.
LaplacianSpectrum laplacian_spectrum(const TriangleMesh& mesh, int count);

// The same of (n) surface points with (n) unit normals that are joined by no triangles, see
// point_cloud_triangles. Throws as above, and for fewer than 16 points.
LaplacianSpectrum laplacian_spectrum(std::span<const Vec3d> points, std::span<const Vec3d> normals,
                                     int count);

}  // namespace astrolith
