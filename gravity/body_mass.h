// Mass, moments and gravity coefficients of a homogeneous closed mesh: integrals of polynomials over its
// volume, each the sum over facets of the integral over the tetrahedron of the facet and the origin.
#pragma once

#include <array>
#include <span>
#include <vector>

#include "geometry/triangle_mesh.h"
#include "numerics/jacobi_rotation.h"
#include "numerics/progress.h"

namespace astrolith {

struct BodyMass {
  double volume = 0.0;  // in cubic units of the mesh
  Vec3d center;         // of mass
  Matrix3 inertia{};    // about the centre of mass for density 1: fifth powers of the unit
};

// The mesh is closed, its faces are counter-clockwise seen from outside.
BodyMass body_mass(const TriangleMesh& mesh);

// The principal moments in ascending order, and unit vectors along their axes. The vectors are right-handed.
struct PrincipalAxes {
  std::array<double, 3> moments{};
  std::array<Vec3d, 3> axes{};
};
// Jacobi's rotations of a symmetric matrix; exact to rounding.
PrincipalAxes principal_axes(const Matrix3& symmetric);

// Coefficients of the potential outside the body,
//   U = G M / r sum over l, m of (a / r)^l P_lm(sin latitude) (C_lm cos m longitude + S_lm sin m longitude),
// with P_lm normalised such that the mean square of each harmonic over the sphere is one ("4 pi normalised",
// without the sign of Condon and Shortley).
struct GravityCoefficient {
  int degree = 0, order = 0;
  double c = 0.0, s = 0.0;
};
constexpr int kMostDegree = 50;

// All coefficients to `degree` in [0, kMostDegree] about `center` for the reference radius a > 0, in units of
// the mesh. Every coefficient is an exact sum over facets; rounding leaves some 1e-14.
// Throws WorkError when progress asks to stop.
std::vector<GravityCoefficient> gravity_coefficients(const TriangleMesh& mesh, const Vec3d& center,
                                                     double radius, int degree,
                                                     const Progress& progress = {});

}  // namespace astrolith
