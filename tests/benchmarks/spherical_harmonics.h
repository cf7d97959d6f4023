// Bodies as spherical harmonics of their radius, fitted by least squares: the usual form of shape models of
// asteroids, for comparison.
#pragma once

#include <vector>

#include "geometry/triangle_mesh.h"

namespace astrolith {

// r(direction) = sum over l <= degree, |m| <= l of (degree + 1)^2 coefficients times real harmonics.
struct SphericalHarmonics {
  int degree = 0;
  Vec3d center;
  std::vector<float> coefficients;
};

// (degree + 1)^2 real harmonics of a unit vector, orthonormal on the sphere: m = 0 first, then cos and sin of
// every m.
void harmonics_at(const Vec3d& direction, int degree, std::vector<float>& values);

// Fits by least squares to points spread evenly over the surface, by conjugate gradients on the normal
// equations (CGLS, Bjoerck 1996). Where a body is not star-shaped about the centre, it gets the mean of its
// radii.
SphericalHarmonics fit_harmonics(const std::vector<Vec3d>& points, const Vec3d& center, int degree);

// A closed mesh of rows x 2 rows directions and the poles.
TriangleMesh harmonics_mesh(const SphericalHarmonics& body, int rows = 240);

}  // namespace astrolith
