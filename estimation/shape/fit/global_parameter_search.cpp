#include "estimation/shape/fit/global_parameter_search.h"

#include <algorithm>
#include <cmath>

#include "descriptor/histogram_distance.h"
#include "descriptor/surflet_histogram.h"
#include "estimation/shape/model/isosurface_projection.h"

namespace astrolith {
namespace {

// The variables of the search are the number of spheres and the logarithms of a, b and m. The ratio a/b lies
// in [1/4, 4], which scales radii by a factor from 1/2 to 2. The sharpness m a lies in [0.25, 16], from a
// soft blend to nearly a union.
constexpr double kTension = 2.0;
constexpr double kSmallestExponent = 0.5, kLargestExponent = 8.0;

Bounds search_bounds(int packed, int max_spheres) {
  const double most = std::min(packed, max_spheres);
  const double t = std::log(kTension);
  return {{std::max(1.0, std::floor(0.25 * most)), -t, -t, std::log(kSmallestExponent)},
          {most, t, t, std::log(kLargestExponent)}};
}

MetaballBody body_at(const std::vector<Sphere>& packing, std::span<const double> x) {
  MetaballBody body;
  const auto count = std::clamp<std::size_t>(static_cast<std::size_t>(std::lround(x[0])), 1, packing.size());
  body.a = std::exp(x[1]);
  body.b = std::exp(x[2]);
  body.blend_exponent = std::exp(x[3]);
  body.spheres.assign(packing.begin(), packing.begin() + static_cast<std::ptrdiff_t>(count));
  return body;
}

}  // namespace

GlobalParameterSearchSummary search_global_parameters(const std::vector<Sphere>& packing,
                                                      const SurfaceSamples& samples,
                                                      const GlobalParameterSearchOptions& options,
                                                      const Progress& progress) {
  const ShapeHistogram wanted = surflet_histogram(samples.points, samples.normals);
  const Objective dissimilarity = [&](std::span<const double> x) {
    const SurfaceSamples projected = project_onto_isosurface(model_of(body_at(packing, x)), samples.points);
    return 1.0 - similarity(wanted, surflet_histogram(projected.points, projected.normals));
  };
  GlobalParameterSearchSummary summary;
  summary.optimization =
      minimize(dissimilarity, search_bounds(static_cast<int>(packing.size()), options.max_spheres),
               options.optimize, progress);
  const MetaballBody body = body_at(packing, summary.optimization.x);
  summary.model = model_of(body);
  summary.a = body.a;
  summary.b = body.b;
  summary.blend_exponent = body.blend_exponent;
  summary.similarity = 1.0 - summary.optimization.value;
  return summary;
}

}  // namespace astrolith
