// The metaball body of a recipe, ready for evaluation in float: over many points at once, and over a box as
// an interval that is never wrong.
#pragma once

#include <algorithm>
#include <limits>
#include <span>
#include <vector>

#include "recipe/recipe.h"
#include "synthesis/body/metaballs.h"

namespace astrolith {

// Metaballs under one set of parameters, in arrays that live elsewhere. Spheres keep the recipe's order,
// subtractive ones after those that add. A sphere adds exactly nothing beyond its support, so a superset
// gives the same bits.
struct MetaballsView {
  const MetaballParameters<float>& parameters;
  std::span<const MetaballSphere<float>> spheres;

  std::span<const MetaballSphere<float>> adding() const { return {spheres.begin(), first_subtractive()}; }
  std::span<const MetaballSphere<float>> subtractive() const { return {first_subtractive(), spheres.end()}; }

 private:
  std::span<const MetaballSphere<float>>::iterator first_subtractive() const {
    return std::partition_point(spheres.begin(), spheres.end(),
                                [](const MetaballSphere<float>& s) { return !s.subtractive(); });
  }
};

// Metaballs that own their arrays: those of a recipe's body without its operations, or what of them reaches a
// box.
struct PreparedMetaballs {
  MetaballParameters<float> parameters;
  std::vector<MetaballSphere<float>> spheres;

  operator MetaballsView() const { return {parameters, spheres}; }
};

// The iso-value is folded into the exponents, so that the sum of kernels is 1 on the surface whatever T is.
// Kernels below e^-20 of that sum are cut off even where the recipe's own cut-off lies farther out: a float
// sum could not hold them.
PreparedMetaballs prepare_metaballs(const MetaballBody& body);

// The spheres whose support reaches the box.
PreparedMetaballs metaballs_reaching(const PreparedMetaballs& metaballs, const Box& box);

// A box that holds the supports of all spheres that add.
Box support_bounds(const MetaballsView& metaballs);

// s(p) and grad L(p) at n points given as three arrays; writes four arrays of n floats, which may not
// overlap the points.
void evaluate_metaballs(const MetaballsView& metaballs, int n, const float* x, const float* y, const float* z,
                        float* distance, float* gradient_x, float* gradient_y, float* gradient_z);

// What is certain about L(p) - log T for every float point p of a box, and about sqrt(|grad L(p)|^2 + floor),
// the divisor of s, for those where |s(p)| <= height; float rounding is allowed for.
struct MetaballInterval {
  double level_min = 0.0;
  double level_max = 0.0;
  double gradient_max = 0.0;
};
// Expects every sphere that reaches the box.
MetaballInterval bound_metaballs(const MetaballsView& metaballs, const Box& box,
                                 double height = std::numeric_limits<double>::infinity());

// A lower bound of the divisor of s.
double smallest_gradient(const MetaballsView& metaballs, const Box& box);

// Gradient of s(p) itself in double precision, second derivatives of L included; per length unit, so about a
// unit vector pointing inwards near the surface.
Vec3d distance_gradient(const MetaballsView& metaballs, const Vec3d& p);

}  // namespace astrolith
