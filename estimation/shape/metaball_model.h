// A body of metaballs as the fit moves it: spheres and one shared sharpness.
//
// Of the thesis's a, b and m (eq. 4.3 to 4.5, T = 1) only two combinations change the surface: the sharpness
// kappa = m a of the blend, and a/b, which scales every radius by sqrt(a/b). The fit therefore works with
// a = b = 1 and m = kappa,
//   k_i(p) = kappa (1 - |p - c_i|^2 / r_i^2),     L(p) = log(sum_i exp k_i) / kappa,
// so that a lone sphere's surface has its own radius.
#pragma once

#include <algorithm>
#include <cmath>
#include <string>
#include <vector>

#include "numerics/errors.h"
#include "recipe/recipe.h"
#include "recipe/recipe_json.h"
#include "synthesis/metaballs.h"

namespace astrolith {

struct MetaballModel {
  double sharpness = 3.0;  // kappa, > 0
  std::vector<Sphere> spheres;
};

// Support of a kernel in its own radii: beyond it exp(k) <= e^-16, less than a float of the sum can hold.
inline double cutoff_radii(double sharpness) { return std::sqrt(1.0 + 16.0 / sharpness); }

inline double largest_radius(const std::vector<Sphere>& spheres) {
  double largest = 0.0;
  for (const Sphere& s : spheres) largest = std::max(largest, s.radius);
  return largest;
}

// As synthesis evaluates the body, in double precision.
inline MetaballParameters<double> evaluation_parameters(const MetaballModel& model) {
  const double floor = 1e-3 / largest_radius(model.spheres);
  const double cutoff = cutoff_radii(model.sharpness);
  return {model.sharpness, model.sharpness, 1.0 / model.sharpness, 0.0, cutoff * cutoff, floor * floor};
}

// The thesis's parameters for the model, rounded as the recipe stores them.
inline MetaballBody metaball_body(const MetaballModel& model) {
  const auto rounded = round_to_seven_digits;
  MetaballBody body;
  body.blend_exponent = rounded(model.sharpness);
  body.cutoff_radii = rounded(cutoff_radii(model.sharpness));
  for (const Sphere& s : model.spheres) {
    body.spheres.push_back(
        {{rounded(s.center.x), rounded(s.center.y), rounded(s.center.z)}, rounded(s.radius)});
  }
  return body;
}

// Throws InputError for kernels other than the Gaussian, which the fit does not know.
inline MetaballModel model_of(const MetaballBody& body) {
  if (body.kernel != Kernel::kGaussian) {
    throw InputError("body: kernel: is " + std::string(kernel_word(body.kernel)) +
                     ", the fit knows gaussian alone");
  }
  if (!body.operations.empty()) throw InputError("body: operations: the fit knows metaballs alone");
  MetaballModel model{body.blend_exponent * body.a, body.spheres};
  const double scale = std::sqrt(body.a / body.b);
  for (Sphere& s : model.spheres) s.radius *= scale;
  return model;
}

}  // namespace astrolith
