// A body of metaballs as the fit moves it: spheres, and one sharpness that they share.
//
// Gaussians. Of the thesis's a, b and m (eq. 4.3 to 4.5, T = 1) only two combinations change the surface: the
// sharpness kappa = m a of the blend, and a/b, which scales every radius by sqrt(a/b). The fit therefore
// works with a = b = 1 and m = kappa,
//   k_i(p) = kappa (1 - |p - c_i|^2 / r_i^2),     L(p) = log(sum_i exp k_i) / kappa.
// The other kernels are summed as they are, m = 1, and their sharpness is the tension a = b:
//   L(p) = sum_i K(|p - c_i|^2 / r_i^2) - 1,      K(0) = e^a, K(1) = 1     (synthesis/body/compact_kernel.h).
// Either way a lone sphere's surface, L = 0, has its own radius.
//
// Gaussians may also take away (synthesis/body/metaballs.h): the sum is then A = P / (1 + N).
#pragma once

#include <vector>

#include "recipe/recipe.h"
#include "synthesis/body/metaballs.h"

namespace astrolith {

struct ModelSphere : Sphere {
  bool subtractive = false;  // Gaussians alone

  ModelSphere(const Sphere& sphere, bool is_subtractive = false)
      : Sphere(sphere), subtractive(is_subtractive) {}
  ModelSphere(const Vec3d& at, double r, bool is_subtractive = false)
      : Sphere{at, r}, subtractive(is_subtractive) {}
};

struct MetaballModel {
  double sharpness = 3.0;            // kappa or a, > 0; the latter at most kMaxTension
  std::vector<ModelSphere> spheres;  // at least one that adds
  Kernel kernel = Kernel::kGaussian;
};

// As synthesis takes it.
inline MetaballSphere<double> kernel_of(const ModelSphere& s) {
  const double inverse_square = 1.0 / (s.radius * s.radius);
  return {s.center, s.subtractive ? -inverse_square : inverse_square};
}

// Derivatives of K's scale, of the logarithm of its height, and of its end by the tension.
struct CompactKernelTension {
  double log_scale = 0.0, log_height = 0.0, low = 0.0;
};

// A model ready to be evaluated, in double precision.
struct ModelEvaluation : MetaballParameters<double> {
  CompactKernelTension tension;  // of kernels other than the Gaussian
};

// Of the spheres that add.
double largest_radius(const MetaballModel& model);

// As synthesis evaluates the body, but for the scale of s away from the surface.
ModelEvaluation evaluation_parameters(const MetaballModel& model);

// Support of a kernel in its own radii.
double support_radii(const MetaballModel& model);

// L where the sum A is `sum`, and how far it moves there without a sphere that holds `share` < 1 of its
// kind's sum.
double level_of(const MetaballModel& model, double sum);
double level_lost(const MetaballModel& model, double sum, double share);

// The thesis's parameters for the model, rounded as the recipe stores them.
MetaballBody metaball_body(const MetaballModel& model);

// Throws InputError for what the fit does not know: combined bodies, and blends other than a plain sum of
// kernels other than the Gaussian.
MetaballModel model_of(const MetaballBody& body);

}  // namespace astrolith
