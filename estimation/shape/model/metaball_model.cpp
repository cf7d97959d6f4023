#include "estimation/shape/model/metaball_model.h"

#include <algorithm>
#include <cmath>
#include <string>

#include "numerics/errors.h"
#include "recipe/recipe_json.h"

namespace astrolith {
namespace {

// Support of a Gaussian, in radii. Beyond it the kernel is at most e^-16, which is lost in the rounding of
// the sum.
double gaussian_support(double sharpness) { return std::sqrt(1.0 + 16.0 / sharpness); }

// Kernels with infinite support are cut off at this many radii.
constexpr double kCutoffRadii = 5.0;

// The least slope that a level is divided by, times the largest radius. A compact kernel has no slope beyond
// its support, and s would be unbounded there. With this floor s is about one radius there. On the surface
// slopes are steeper, and the floor hardly changes s.
double slope_floor(Kernel kernel) { return kernel == Kernel::kGaussian ? 1e-3 : 0.5; }

CompactKernel<double> compact_kernel_of(Kernel kernel, double tension, double& cutoff_squared) {
  cutoff_squared = kCutoffRadii * kCutoffRadii;
  return scaled_kernel(kernel, tension, 1.0, cutoff_squared);
}

// Taken by central differences, because the scale of a compact kernel is found by bisection. This is done
// once for all points.
CompactKernelTension tension_derivatives(Kernel kernel, double tension) {
  const double h = 1e-4;
  double cutoff_squared = 0.0;
  const CompactKernel<double> more = compact_kernel_of(kernel, tension + h, cutoff_squared);
  const CompactKernel<double> less = compact_kernel_of(kernel, tension - h, cutoff_squared);
  return {std::log(more.scale / less.scale) / (2.0 * h), std::log(more.height / less.height) / (2.0 * h),
          (more.low - less.low) / (2.0 * h)};
}

}  // namespace

double largest_radius(const MetaballModel& model) {
  double largest = 0.0;
  for (const ModelSphere& s : model.spheres) {
    if (!s.subtractive) largest = std::max(largest, s.radius);
  }
  return largest;
}

ModelEvaluation evaluation_parameters(const MetaballModel& model) {
  ModelEvaluation evaluation;
  const double floor = slope_floor(model.kernel) / largest_radius(model);
  evaluation.gradient_floor = floor * floor;
  if (model.kernel == Kernel::kGaussian) {
    const double support = gaussian_support(model.sharpness);
    evaluation.m_a = evaluation.m_b = model.sharpness;
    evaluation.inverse_m = 1.0 / model.sharpness;
    evaluation.cutoff_squared = support * support;
    return evaluation;
  }
  evaluation.m = evaluation.inverse_m = 1.0;
  evaluation.compact_kernel = compact_kernel_of(model.kernel, model.sharpness, evaluation.cutoff_squared);
  evaluation.tension = tension_derivatives(model.kernel, model.sharpness);
  return evaluation;
}

double support_radii(const MetaballModel& model) {
  if (model.kernel == Kernel::kGaussian) return gaussian_support(model.sharpness);
  double cutoff_squared = 0.0;
  compact_kernel_of(model.kernel, model.sharpness, cutoff_squared);
  return std::sqrt(cutoff_squared);
}

double level_of(const MetaballModel& model, double sum) {
  const double total = sum + double{kKernelFloor};
  return model.kernel == Kernel::kGaussian ? std::log(total) / model.sharpness : total - 1.0;
}

double level_lost(const MetaballModel& model, double sum, double share) {
  return model.kernel == Kernel::kGaussian ? -std::log1p(-share) / model.sharpness : share * sum;
}

MetaballBody metaball_body(const MetaballModel& model) {
  const auto rounded = round_to_seven_digits;
  MetaballBody body;
  body.kernel = model.kernel;
  if (model.kernel == Kernel::kGaussian) {
    body.blend_exponent = rounded(model.sharpness);
    body.cutoff_radii = rounded(gaussian_support(model.sharpness));
  } else {
    body.a = body.b = rounded(model.sharpness);
    body.cutoff_radii = kCutoffRadii;
  }
  for (const ModelSphere& s : model.spheres) {
    (s.subtractive ? body.subtract : body.spheres)
        .push_back({{rounded(s.center.x), rounded(s.center.y), rounded(s.center.z)}, rounded(s.radius)});
  }
  return body;
}

MetaballModel model_of(const MetaballBody& body) {
  if (!body.operations.empty()) throw InputError("body: operations: the fit knows metaballs alone");
  const bool gaussian = body.kernel == Kernel::kGaussian;
  if (!gaussian && body.blend_exponent != 1.0) {
    throw InputError("body: blend_exponent: the fit knows kernel " + std::string(kernel_word(body.kernel)) +
                     " with exponent 1 alone");
  }
  if (!gaussian && !body.subtract.empty()) {
    throw InputError("body: subtract: the fit knows subtractive metaballs with the Gaussian kernel alone");
  }
  MetaballModel model{body.blend_exponent * body.a, {body.spheres.begin(), body.spheres.end()}, body.kernel};
  for (const Sphere& s : body.subtract) model.spheres.emplace_back(s, true);
  const double scale = std::sqrt(body.a / body.b);
  for (ModelSphere& s : model.spheres) s.radius *= scale;
  return model;
}

}  // namespace astrolith
