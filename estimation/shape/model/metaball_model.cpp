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

// The least slope that a level is divided by, times the largest radius.
constexpr double kSlopeFloor = 1e-3;

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
  const double floor = kSlopeFloor / largest_radius(model), support = gaussian_support(model.sharpness);
  evaluation.gradient_floor = floor * floor;
  evaluation.m_a = evaluation.m_b = model.sharpness;
  evaluation.inverse_m = 1.0 / model.sharpness;
  evaluation.cutoff_squared = support * support;
  return evaluation;
}

double support_radii(const MetaballModel& model) { return gaussian_support(model.sharpness); }

double level_of(const MetaballModel& model, double sum) {
  return std::log(sum + double{kKernelFloor}) / model.sharpness;
}

double level_lost(const MetaballModel& model, double share) { return -std::log1p(-share) / model.sharpness; }

MetaballBody metaball_body(const MetaballModel& model) {
  const auto rounded = round_to_seven_digits;
  MetaballBody body;
  body.blend_exponent = rounded(model.sharpness);
  body.cutoff_radii = rounded(gaussian_support(model.sharpness));
  for (const ModelSphere& s : model.spheres) {
    (s.subtractive ? body.subtract : body.spheres)
        .push_back({{rounded(s.center.x), rounded(s.center.y), rounded(s.center.z)}, rounded(s.radius)});
  }
  return body;
}

MetaballModel model_of(const MetaballBody& body) {
  if (!body.operations.empty()) throw InputError("body: operations: the fit knows metaballs alone");
  if (body.kernel != Kernel::kGaussian) throw InputError("body: kernel: the fit knows the Gaussian alone");
  MetaballModel model{body.blend_exponent * body.a, {body.spheres.begin(), body.spheres.end()}};
  for (const Sphere& s : body.subtract) model.spheres.emplace_back(s, true);
  const double scale = std::sqrt(body.a / body.b);
  for (ModelSphere& s : model.spheres) s.radius *= scale;
  return model;
}

}  // namespace astrolith
