#include "synthesis/body/metaball_body.h"

#include <algorithm>
#include <cmath>

#include "numerics/portable_double.h"
#include "synthesis/body/metaball_box.h"

namespace astrolith {
namespace {

// The exponent below that of the surface at which a kernel is cut off.
constexpr double kNegligibleExponent = 20.0;

// The parameters of a body whose kernel is not the Gaussian, except for the gradient floor.
MetaballParameters<float> compact_parameters(const MetaballBody& body) {
  double cutoff_squared = body.cutoff_radii * body.cutoff_radii;
  const CompactKernel<double> compact_kernel =
      scaled_kernel(body.kernel, body.a, body.a / body.b, cutoff_squared);
  MetaballParameters<float> parameters;
  parameters.m = static_cast<float>(body.blend_exponent);
  parameters.inverse_m = static_cast<float>(1.0 / body.blend_exponent);
  parameters.cutoff_squared = static_cast<float>(cutoff_squared);
  parameters.compact_kernel = {compact_kernel.kernel, static_cast<float>(compact_kernel.scale),
                               static_cast<float>(compact_kernel.low),
                               static_cast<float>(compact_kernel.height / body.iso_value)};
  return parameters;
}

MetaballSphere<float> in_float(const Sphere& s) {
  return {to_float(s.center), static_cast<float>(1.0 / (s.radius * s.radius))};
}

}  // namespace

PreparedMetaballs prepare_metaballs(const MetaballBody& body) {
  const double m = body.blend_exponent;
  const double log_iso = portable::log(body.iso_value);
  double largest_radius = 0.0;
  PreparedMetaballs prepared;
  for (const Sphere& s : body.spheres) {
    largest_radius = std::max(largest_radius, s.radius);
    prepared.spheres.push_back(in_float(s));
  }
  for (const Sphere& s : body.subtract) {
    prepared.spheres.push_back(in_float(s));
    prepared.spheres.back().inverse_radius_squared *= -1.0f;
  }
  const double gradient_floor = 1e-3 / largest_radius;
  if (body.kernel != Kernel::kGaussian) {
    prepared.parameters = compact_parameters(body);
    prepared.parameters.gradient_floor = static_cast<float>(gradient_floor * gradient_floor);
    return prepared;
  }
  const double negligible = (body.a - log_iso + kNegligibleExponent / m) / body.b;
  const double cutoff_squared = std::max(0.0, std::min(body.cutoff_radii * body.cutoff_radii, negligible));
  prepared.parameters = {static_cast<float>(m * (body.a - log_iso)),
                         static_cast<float>(m * body.b),
                         static_cast<float>(1.0 / m),
                         0.0f,
                         static_cast<float>(cutoff_squared),
                         static_cast<float>(gradient_floor * gradient_floor),
                         {},
                         0.0f};
  return prepared;
}

PreparedMetaballs metaballs_reaching(const PreparedMetaballs& metaballs, const Box& box) {
  PreparedMetaballs reaching{metaballs.parameters, {}};
  for (const MetaballSphere<float>& s : metaballs.spheres) {
    if (reaches_box(s, static_cast<double>(metaballs.parameters.cutoff_squared), box)) {
      reaching.spheres.push_back(s);
    }
  }
  return reaching;
}

Box support_bounds(const MetaballsView& metaballs) {
  Box box;
  for (const MetaballSphere<float>& s : metaballs.adding()) {
    const double reach =
        std::sqrt((1.0 + kDistanceSlack) * static_cast<double>(metaballs.parameters.cutoff_squared) /
                  static_cast<double>(s.inverse_radius_squared));
    const Vec3d c{s.center.x, s.center.y, s.center.z};
    box.extend(c - Vec3d{reach, reach, reach});
    box.extend(c + Vec3d{reach, reach, reach});
  }
  return box;
}

}  // namespace astrolith
