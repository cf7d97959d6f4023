// A body of metaballs as the fit changes it: spheres, and one sharpness that they share.
//
// The thesis has the parameters a, b and m (eq. 4.3 to 4.5, with T = 1). For Gaussians only two combinations
// change the surface: the sharpness kappa = m a of the blend, and a/b, which scales every radius by
// sqrt(a/b). The fit therefore works with a = b = 1 and m = kappa:
//   k_i(p) = kappa (1 - |p - c_i|^2 / r_i^2),     L(p) = log(sum_i exp k_i) / kappa.
// The surface L = 0 of a lone sphere has the sphere's radius. Other kernels than the Gaussian came a quarter
// as close in fits; a fitted body has none.
//
// Metaballs may be subtractive (synthesis/body/metaballs.h). The sum is then A = P / (1 + N), where
// P is the sum of the additive ones and N the sum of the subtractive ones.
//
// Levels, distances and projections of many points are computed in parallel, by the equations of
// block_kernels.h. The results do not depend on the number of threads.
#pragma once

#include <span>
#include <vector>

#include "geometry/surface/mesh_sampling.h"
#include "recipe/recipe.h"
#include "synthesis/body/metaballs.h"

namespace astrolith {

struct ModelSphere : Sphere {
  bool subtractive = false;

  ModelSphere(const Sphere& sphere, bool is_subtractive = false)
      : Sphere(sphere), subtractive(is_subtractive) {}
  ModelSphere(const Vec3d& at, double r, bool is_subtractive = false)
      : Sphere{at, r}, subtractive(is_subtractive) {}
};

struct MetaballModel {
  double sharpness = 3.0;            // kappa > 0
  std::vector<ModelSphere> spheres;  // at least one is additive
};

// The sphere in the form that synthesis evaluates.
inline MetaballSphere<double> make_kernel(const ModelSphere& s) {
  const double inverse_square = 1.0 / (s.radius * s.radius);
  return {s.center, s.subtractive ? -inverse_square : inverse_square};
}

// A model ready to be evaluated, in double precision.
using ModelEvaluation = MetaballParameters<double>;

// The largest radius of the additive metaballs.
double largest_radius(const MetaballModel& model);

// Parameters with which the model is evaluated as synthesis evaluates the body. Only the scale of s away from
// the surface differs.
ModelEvaluation evaluation_parameters(const MetaballModel& model);

// The support of a metaball, as a multiple of its radius.
double support_radii(const MetaballModel& model);

// The level L at a point where the sum A is `sum`.
double model_level(const MetaballModel& model, double sum);

// How much L changes at this point if a metaball is removed that holds `share` < 1 of its kind's sum.
double level_lost(const MetaballModel& model, double share);

// The thesis's parameters for the model, rounded as the recipe stores them.
MetaballBody metaball_body(const MetaballModel& model);

// The model of a recipe's body. Throws InputError for bodies that the fit does not support: bodies made by
// operations, and other kernels than the Gaussian.
MetaballModel to_model(const MetaballBody& body);

// Takes Newton steps p <- p + s(p) n with n = -grad L / |grad L|. No step is longer than the largest radius.
// The normals have length 1 and point out of the body. A point that no sphere reaches stays where it is, and
// its normal points away from the nearest sphere.  (#points in, #points out)
SurfaceSamples project_onto_isosurface(const MetaballModel& model, std::span<const Vec3d> points,
                                       int steps = 4);

// The level L of every point: 0 on the surface, positive inside, without unit.  (#points)
std::vector<double> model_levels(const MetaballModel& model, std::span<const Vec3d> points);

// The first-order signed distance s of every point: positive inside, in length units.  (#points)
std::vector<double> model_distances(const MetaballModel& model, std::span<const Vec3d> points);

}  // namespace astrolith
