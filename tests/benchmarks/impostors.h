// Surfaces that look like a body's and are not: what a test of realism has to reject. And the body's own
// surface with other triangles, which it should accept.
#pragma once

#include <cstdint>

#include "descriptor/surface/surface_statistics.h"
#include "geometry/triangle_mesh.h"

namespace astrolith {

// The body without what is finer than some 10 edges, with homogeneous fractal noise in its place: octaves of
// random waves of 24, 12, 6 and 3 edges. Amplitude and gain are set so that the means of the logarithm of the
// roughness within 3 and 12 edges are the body's.
TriangleMesh noise_impostor(const TriangleMesh& body, std::uint64_t seed);

// The body smoothed by sixty half steps of Laplace, with a share of the relief that this took away.
TriangleMesh relief_impostor(const TriangleMesh& body, double share);

// Each vertex in the mean of its neighbours.
TriangleMesh laplace_impostor(const TriangleMesh& body);

// A quarter of the vertices, chosen by quadric error metrics, and each triangle cut into four.
TriangleMesh decimated_impostor(const TriangleMesh& body);

// Spherical harmonics of the radius to degree 30, with about as many triangles.
TriangleMesh harmonics_impostor(const TriangleMesh& body);

// The zero set of the body's signed distance by marching cubes, with about as many triangles. The body must
// be closed.
TriangleMesh remeshed(const TriangleMesh& body, double triangles);

}  // namespace astrolith
