// The level of Gaussian metaballs over a box, enclosed by a linear function and a square. One expansion about
// the centre of a block tells for most points of the block that they lie inside or outside the body. The
// evaluation would visit every sphere at every point.
//
// Let phi = log P, with k_i, P, N and L as in metaballs.h. Each k_i is quadratic around the centre p0,
//
//   k_i(p0 + d) = k_i(p0) + v_i.d - c_i |d|^2 / 2,    c_i = 2 m b / r_i^2.
//
// With w = softmax(k), the second derivative of phi along a unit vector lies between
//
//   -sum_i w_i c_i    and    sum_i w_i |grad k_i - a|^2 - sum_i w_i c_i    for any vector a.
//
// Let a and e be the means of v_i and c_i by the weights w_i(p0). A common factor of all kernels changes no
// weight, and Jensen's inequality bounds the sum of the kernels from below. For |d| <= R therefore
//
//   w_i(p0 + d) <= w_i(p0) exp(beta_i + sum_j w_j(p0) beta_j),    beta_i = |v_i - a| R + |c_i - e| R^2 / 2.
//
// log(1 + N) is bounded likewise, where the 1 is a kernel with v = 0 and c = 0. Kernels whose supports end in
// the box are added as intervals.
#pragma once

#include <optional>

#include "synthesis/body/metaball_body.h"

namespace astrolith {

// For the float points p0 + d of a box, evaluate_metaballs() finds
//
//   L - log T within level + gradient.d + [-below |d|^2 - slack, above |d|^2 + slack],
//   grad L within turn |d| + turn_slack of the gradient.
struct LevelExpansion {
  Vec3f center;    // p0, length units
  float level;     // without unit, like L
  Vec3f gradient;  // per length unit
  float below, above, slack;
  float turn, turn_slack;
};

// The expansion about the centre of the box. Expects every sphere that reaches the box. Empty for kernels
// other than the Gaussian. Empty also where no bound is of use: far from all spheres, where exponents
// saturate, and where the supports of kernels that matter end.
std::optional<LevelExpansion> expand_level(const MetaballsView& metaballs, const Box& box);

// Bounds over the box of an expansion, as bound_metaballs() and smallest_gradient() give them, but from one
// visit of each sphere.
struct ExpansionBounds {
  MetaballInterval interval;
  double divisor_min = 0.0;  // a lower bound of the divisor of s
  bool tight = false;  // whether the level is nearly linear over the box: these bounds are the better ones
};
ExpansionBounds bound_expansion(const LevelExpansion& expansion, const MetaballParameters<float>& body,
                                const Box& box);

// A box that holds the first-order projections (surface_projection.h) of those points of the box with
// |s| <= longest_step. Expects the bounds of the same expansion.
Box projected_box(const LevelExpansion& expansion, const ExpansionBounds& bounds,
                  const MetaballParameters<float>& body, const Box& box, double longest_step);

}  // namespace astrolith
