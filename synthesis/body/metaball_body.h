// Metaballs of a recipe, prepared for float evaluation over many points at once, and bounds of them over
// boxes.
#pragma once

#include <algorithm>
#include <limits>
#include <span>
#include <vector>

#include "recipe/recipe.h"
#include "synthesis/body/metaballs.h"

namespace astrolith {

// A view of metaballs with one set of parameters. Spheres keep the order of the recipe; subtractive spheres
// come last. A sphere contributes exactly 0 beyond its support, so that extra spheres change no bit.
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

// Metaballs that own their arrays: those of a body without its operations, or the ones that reach a box.
struct PreparedMetaballs {
  MetaballParameters<float> parameters;
  std::vector<MetaballSphere<float>> spheres;

  operator MetaballsView() const { return {parameters, spheres}; }
};

// Converts the metaballs of a body to float. The iso-value T is folded into the exponents, so that the sum of
// kernels is 1 on the surface for any T. Kernels below e^-20 of this sum are cut off even if the recipe's
// cut-off lies farther out, since a float sum could not hold them.
PreparedMetaballs prepare_metaballs(const MetaballBody& body);

// The metaballs whose supports reach the box.
PreparedMetaballs metaballs_reaching(const PreparedMetaballs& metaballs, const Box& box);

// A box that holds the supports of all spheres that add.
Box support_bounds(const MetaballsView& metaballs);

// Writes s(p), length units, and grad L(p) (grad M(p) for kernels other than the Gaussian) at n points. The
// four output arrays of n floats may not overlap the points.
void evaluate_metaballs(const MetaballsView& metaballs, int n, const float* x, const float* y, const float* z,
                        float* distance, float* gradient_x, float* gradient_y, float* gradient_z);

// Bounds over a box that allow for float rounding: L(p) - log T (M(p) - 1 for kernels other than the
// Gaussian) for every float point p, and the divisor sqrt(|grad L(p)|^2 + floor) of s for the points with
// |s(p)| <= height.
struct MetaballInterval {
  double level_min = 0.0;
  double level_max = 0.0;
  double gradient_max = 0.0;
};
// Expects every sphere that reaches the box. `height` is in length units.
MetaballInterval bound_metaballs(const MetaballsView& metaballs, const Box& box,
                                 double height = std::numeric_limits<double>::infinity());

// A lower bound of the divisor of s over a box.
double smallest_gradient(const MetaballsView& metaballs, const Box& box);

// The exact gradient of s(p) in double precision, with the second derivatives of L, per length unit. Near the
// surface it is about a unit vector that points inwards.
Vec3d distance_gradient(const MetaballsView& metaballs, const Vec3d& p);

}  // namespace astrolith
