// shapeDNA: the lowest eigenvalues of the Laplace-Beltrami operator of a surface, the tones it would sound as
// a drum.
//
// Reuter, Wolter and Peinecke, "Laplace-Beltrami spectra as 'Shape-DNA' of surfaces and solids",
// Computer-Aided Design 2006. They use cubic elements. Here elements are linear: L x = lambda M x with the
// cotangent stiffness L and the lumped mass M (a third of each triangle's area to each corner). The spectrum
// does not change when a surface is moved, turned or bent without stretching. Multiplied by the area it does
// not change with the scale either.
//
// A cloud of points gets triangles between neighbours, enough of them for a Laplacian, though they form no
// surface (Sharp and Crane, "A Laplacian for nonmanifold triangle meshes", SGP 2020, section 5.7). The
// neighbours of each point are projected into its tangent plane, and the triangles that meet at the point in
// their Delaunay triangulation are taken. Most triangles are found from each of their corners, so that all
// triangles together cover the surface about three times.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "geometry/triangle_mesh.h"

namespace astrolith {

// Triangles among each point and its `neighbours` nearest points. normals (n) are unit vectors. Throws
// InputError unless there is a normal for each point and 3 <= neighbours < n.
std::vector<Triangle> point_cloud_triangles(std::span<const Vec3d> points, std::span<const Vec3d> normals,
                                            int neighbours);

struct LaplacianSpectrum {
  std::vector<double> eigenvalues;      // (count) ascending, times the area: without a unit, >= 0
  double area = 0;                      // in the squared unit of the coordinates
  std::int64_t left_out_triangles = 0;  // triangles without area, which have no cotangents
};

// The lowest `count` eigenvalues after the first, which is 0. Every further component adds one more 0. On a
// sphere the eigenvalues approximate l (l + 1) 4 pi, each 2 l + 1 times. Boundaries are free (Neumann's
// condition), and the winding of faces does not matter. Throws InputError for edges of three or more
// triangles, for a mesh without area, for more than 500,000 vertices, for count < 1, and for too few
// vertices. Throws WorkError when the eigensolver does not converge.
LaplacianSpectrum laplacian_spectrum(const TriangleMesh& mesh, int count);

// The lowest eigenvalues of (n) surface points with (n) unit normals, joined by point_cloud_triangles. Throws
// as above, and InputError for fewer than 16 points.
LaplacianSpectrum laplacian_spectrum(std::span<const Vec3d> points, std::span<const Vec3d> normals,
                                     int count);

}  // namespace astrolith
