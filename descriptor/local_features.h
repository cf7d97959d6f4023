// The two features of a single point that the adaptive hybrid descriptor adds to a pair: those of the pair's
// origin (thesis 3.3.2 and eq. 3.4). The thesis swaps their names between sections; here they are as listed
// below eq. 3.3:
//   eta   = angle between the normal and the position seen from the centre, in [0, pi]: normal perturbation
//   kappa = Gaussian curvature K made free of scale and bounded: x / (1 + |x|) in (-1, 1) with x = K r^2
// The centre is the mean of the points, and r^2 is their mean squared distance from it. A sphere has eta = 0
// and kappa = 1/2 everywhere; a plane has kappa = 0. Both axes are cut into equal bins.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "numerics/vec3.h"

namespace astrolith {

// eta, in [0, pi]; pi / 2 where the point is the centre.
double normal_perturbation(const Vec3d& point, const Vec3d& unit_normal, const Vec3d& center);

// kappa, in (-1, 1), from x = K r^2.
double bounded_curvature(double scale_free_curvature);

// The mean of the points and their mean squared distance from it.
struct PointSpread {
  Vec3d center;
  double mean_square = 0;  // in the squared unit of the points
};
PointSpread point_spread(std::span<const Vec3d> points);

// (n) the bin of eta times `bins` plus the bin of kappa, for points with unit normals and Gaussian curvatures
// (1 / length^2).
std::vector<std::int32_t> local_codes(std::span<const Vec3d> points, std::span<const Vec3d> normals,
                                      std::span<const double> curvatures, int bins);

}  // namespace astrolith
