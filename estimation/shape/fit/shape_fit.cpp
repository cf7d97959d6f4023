#include "estimation/shape/fit/shape_fit.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "descriptor/histogram_distance.h"
#include "descriptor/surflet_histogram.h"
#include "estimation/shape/fit/fit_check.h"
#include "estimation/shape/fit/rounded_body.h"
#include "estimation/shape/model/metaball_model.h"
#include "estimation/shape/packing/sphere_packing.h"
#include "numerics/errors.h"
#include "numerics/portable_double.h"

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

// The share of the metaballs that the packing gives. The others are added where the error is largest.
constexpr double kBaseShare = 0.5;
constexpr int kFewSpheres = 16;  // so many metaballs may all come from the packing

// The numbers of a body keep the digits that matter: without the others its mean distance grows by this
// share.
constexpr double kMostDigitsLoss = 0.01;

// Bytes of compact recipes, measured on Eros, Bennu and Kleopatra: 200 metaballs lose 1 to 5 % at 4 bytes
// each, and 6 to 18 % at 3.5. More metaballs are smaller and need finer steps.
constexpr double kText = 45.0, kBytesEach = 4.1, kMoreForTwice = 0.15;

constexpr std::int64_t kSearchSamples = 800;  // the cost of a fitness grows with the square

// Independent random streams of one seed.
enum Stream : std::uint64_t { kSurface = 1, kContainment, kSearch, kDistances = 7, kShellsAround };

std::uint64_t stream_seed(std::uint64_t seed, Stream stream) { return 1000003u * seed + stream; }

void check_options(const ShapeFitOptions& options) {
  if (options.spheres < 1 || options.spheres > 10000) throw InputError("spheres: give 1 to 10000");
  if (options.points != 0 && (options.points < 100 || options.points > 10000000)) {
    throw InputError("points: give 100 to 10000000, or 0");
  }
  if (options.population < 1 || options.generations < 1) {
    throw InputError("population and generations: give at least 1");
  }
  if (!(options.subtract >= 0.0 && options.subtract <= 0.9)) throw InputError("subtract: give 0 to 0.9");
  if (!(options.tolerance >= 0.0)) throw InputError("tolerance: give a fraction of the diagonal, at least 0");
}

Packing pack(const TargetBody& target, const ShapeFitOptions& options, const Progress& progress) {
  PackingOptions packing;
  packing.max_spheres =
      std::max(std::min(options.spheres, kFewSpheres), static_cast<int>(kBaseShare * options.spheres));
  Packing result = pack_spheres(target.mesh, target.tree, packing, progress);
  if (result.spheres.empty()) throw InputError("no sphere fits inside the body; give a solid body");
  return result;
}

GlobalParameterSearchSummary search(const TargetBody& target, const Packing& packing,
                                    const ShapeFitOptions& options, const Progress& progress) {
  GlobalParameterSearchOptions search_options;
  search_options.max_spheres = static_cast<int>(packing.spheres.size());
  search_options.optimize.algorithm = options.optimizer;
  search_options.optimize.population = options.population;
  search_options.optimize.max_evaluations = std::int64_t{options.population} * options.generations;
  search_options.optimize.seed = options.seed;
  const SurfaceSamples samples =
      sample_poisson_disk(target.surface, kSearchSamples, stream_seed(options.seed, kSearch));
  return search_global_parameters(packing.spheres, samples, search_options, progress);
}

// The model of a fit, and its body in the file's frame.
struct RefinedBody {
  AdaptiveFitSummary fit;
  MetaballBody body;
};

MetaballBody body_in_file_frame(const MetaballModel& model, const TargetBody& target) {
  MetaballModel moved = model;
  for (ModelSphere& s : moved.spheres) {
    s.center = target.center + target.diagonal * s.center;
    s.radius *= target.diagonal;
  }
  return metaball_body(moved);
}

MetaballBody rounded_body(const TargetBody& target, const MetaballModel& model, const SurfaceSamples& samples,
                          FitPoints points, const AdaptiveFitOptions& adaptive,
                          const ShapeFitOptions& options) {
  points.on_surface = samples.points;
  RoundingOptions rounding;
  rounding.bytes = static_cast<std::size_t>(options.bytes);
  rounding.length_unit = options.length_unit;
  rounding.check_resolution = options.check_resolution;
  rounding.refinement.loss_scale = adaptive.loss_scale;
  rounding.refinement.containment_weight = adaptive.containment_weight;
  rounding.refinement.keep_centers_inside = &target.tree;
  if (options.bytes > 0) return round_body(target, model, points, rounding).body;
  const auto few_digits = round_body_to_digits(target, model, points, rounding, kMostDigitsLoss);
  return few_digits ? few_digits->body : body_in_file_frame(model, target);
}

RefinedBody refine_model(const TargetBody& target, const Packing& packing, const MetaballModel& start,
                         const ShapeFitOptions& options, const Progress& progress) {
  const std::int64_t count =
      options.points > 0 ? options.points : std::max(kFewestPoints, kPointsPerSphere * options.spheres);
  const RefinedBody unrefined{{start, {}, true}, body_in_file_frame(start, target)};
  if (!report(progress, 0.0, "samples")) return unrefined;
  const SurfaceSamples samples = sample_poisson_disk(
      target.surface, count, stream_seed(options.seed, kSurface), SampleNormals::interpolated);
  if (!report(progress, 0.0, "containment points")) return unrefined;
  const FitPoints containment = containment_points(
      target, {packing.spheres.front().radius, count, stream_seed(options.seed, kContainment),
               stream_seed(options.seed, kShellsAround)});
  AdaptiveFitOptions adaptive = options_for(options.spheres);
  adaptive.tolerance = options.tolerance;
  adaptive.subtractive = options.subtract;
  adaptive.repair_resolution = options.check_resolution;
  if (!report(progress, 0.0, "starting")) return unrefined;
  AdaptiveFitSummary fit = fit_adaptively(target, start, samples, containment, adaptive, progress);
  const bool round = options.bytes > 0 || !fit.interrupted;
  MetaballBody body = round ? rounded_body(target, fit.model, samples, containment, adaptive, options)
                            : body_in_file_frame(fit.model, target);
  return {std::move(fit), std::move(body)};
}

}  // namespace

GlobalParameterSearchSummary search_global_parameters(const std::vector<Sphere>& packing,
                                                      const SurfaceSamples& samples,
                                                      const GlobalParameterSearchOptions& options,
                                                      const Progress& progress) {
  const ShapeHistogram wanted = surflet_histogram(samples.points, samples.normals);
  const Objective dissimilarity = [&](std::span<const double> x) {
    const SurfaceSamples projected = project_onto_isosurface(to_model(body_at(packing, x)), samples.points);
    return 1.0 - similarity(wanted, surflet_histogram(projected.points, projected.normals));
  };
  GlobalParameterSearchSummary summary;
  summary.optimization =
      minimize(dissimilarity, search_bounds(static_cast<int>(packing.size()), options.max_spheres),
               options.optimize, progress);
  const MetaballBody body = body_at(packing, summary.optimization.x);
  summary.model = to_model(body);
  summary.a = body.a;
  summary.b = body.b;
  summary.blend_exponent = body.blend_exponent;
  summary.similarity = 1.0 - summary.optimization.value;
  return summary;
}

int spheres_for_bytes(int bytes) {
  const double doublings = portable::log(bytes / 1250.0) / std::numbers::ln2;
  const double bytes_each = std::max(3.5, kBytesEach + kMoreForTwice * doublings);
  return static_cast<int>(std::clamp((bytes - kText) / bytes_each, 1.0, 10000.0));
}

int bytes_for_spheres(int spheres) {
  constexpr double kBytesMore = 150.0;  // few metaballs are large, and share little
  return static_cast<int>(std::ceil(kText + kBytesMore + kBytesEach * spheres));
}

void measure_fit(const TargetBody& target, const ShapeFitOptions& options, ShapeFitResult& result) {
  const std::uint64_t seed = options.seed;
  result.check = check_fit(target, in_target_frame(target, result.body), options.check_resolution,
                           options.check_samples, stream_seed(seed, kDistances));
}

ShapeFitResult fit_shape(const TargetBody& target, const ShapeFitOptions& options,
                         const StageProgress& progress) {
  check_options(options);
  ShapeFitResult result;
  const Packing packing = pack(target, options, progress("pack"));
  const GlobalParameterSearchSummary base = search(target, packing, options, progress("search"));
  auto [fit, body] = refine_model(target, packing, base.model, options, progress("refine"));
  result.body = std::move(body);
  result.filling_rate = packing.filling_rate;
  result.base_similarity = base.similarity;
  result.base_spheres = static_cast<int>(base.model.spheres.size());
  result.evaluations = base.optimization.evaluations;
  result.search_history = base.optimization.history;
  result.convergence = std::move(fit.convergence);
  result.interrupted = packing.interrupted || fit.interrupted;
  if (!result.interrupted) measure_fit(target, options, result);
  return result;
}

}  // namespace astrolith
