#include "descriptor/features/found_features.h"

#include <algorithm>
#include <cmath>
#include <optional>

#include "descriptor/features/crater_fit_internal.h"
#include "descriptor/surface/surface_statistics.h"
#include "numerics/errors.h"
#include "numerics/portable_double.h"
#include "numerics/reported_loop.h"

namespace astrolith {
namespace {

constexpr std::array<double, 3> kStarts{0.75, 1.0, 1.35};  // of the radius that the blob's scale suggests
constexpr std::size_t kFewestTriangles = 1000;
constexpr std::int64_t kLeastPoints = 500, kGreatestPoints = 1'000'000;

// The terms whose weighted sum is the logarithm of the odds that a fit is a crater: 1, log(1 - explained),
// completeness of walls, of crests, log(depth / diameter) and its square, rim over depth and its square,
// log(saddle), bend and its square, log(residual within the rim), log(residual), log(diameter in edges).
using Terms = std::array<double, 14>;
Terms make_terms(const CraterFit& fit, double edge) {
  const FitMeasures& m = fit.measures;
  const auto clamped_log = [](double v, double low, double high) {
    return portable::log(std::clamp(v, low, high));
  };
  const double depth = clamped_log(0.5 * fit.depth / fit.radius, 0.005, 0.5);
  const double rim = std::clamp(fit.rim_height / fit.depth, -0.5, 1.5), bend = std::clamp(m.bend, -3.0, 3.0);
  return {1.0,
          clamped_log(1.0 - m.explained, 0.01, 2.0),
          m.walls,
          m.crests,
          depth,
          depth * depth,
          rim,
          rim * rim,
          clamped_log(m.saddle, 0.02, 5.0),
          bend,
          bend * bend,
          clamped_log(m.inner, 0.01, 3.0),
          clamped_log(m.residual, 0.01, 3.0),
          clamped_log(2.0 * fit.radius / edge, 4.0, 100.0)};
}

// Weights by logistic regression on the bodies `fitted` of tests/benchmarks/found_craters.py.
constexpr Terms kCraterWeights{7.235,  -1.680, -4.748, 1.409,  1.022,  -0.389, 6.237,
                               -1.104, -0.155, -0.158, -0.469, -3.028, 0.443,  -2.400};

// These weights are for boulders, of made bodies with boulders, hills and some with craters.
constexpr Terms kBoulderWeights{-2.282, 0.043,  -1.850, 1.279,   -0.459, -0.076, 0.654,
                                -1.056, -0.103, -4.804, -13.393, -0.956, -0.870, 0.333};

double crater_confidence(const CraterFit& fit, double edge, const Terms& weights) {
  const Terms terms = make_terms(fit, edge);
  double odds = 0.0;
  for (std::size_t k = 0; k < terms.size(); ++k) odds += weights[k] * terms[k];
  return 1.0 / (1.0 + portable::exp(-odds));
}

FoundFeature make_feature(const CraterFit& fit, BlobSign sign, double confidence) {
  const bool crater = sign == BlobSign::hollow;
  FoundFeature f{sign,      {},  fit.center, fit.normal,          2.0 * fit.radius,
                 fit.depth, 0.0, 0.0,        fit.measures.crests, confidence};
  f.place = fit.center + ((crater ? -1.0 : 1.0) * fit.depth) * fit.normal;
  if (!crater) return f;
  f.rim_height = std::max(0.0, fit.rim_height);
  f.freshness = std::clamp((fit.depth + fit.rim_height) / (kFreshDepth * f.diameter), 0.0, 1.0);
  return f;
}

void sort_by_confidence(std::vector<FoundFeature>& found) {
  std::stable_sort(found.begin(), found.end(),
                   [](const FoundFeature& a, const FoundFeature& b) { return a.confidence > b.confidence; });
}

// Whether two are fits to one landform: centres within half the larger radius, and sizes within 1.8.
bool are_one(const FoundFeature& a, const FoundFeature& b) {
  const double larger = std::max(a.diameter, b.diameter), smaller = std::min(a.diameter, b.diameter);
  return larger < 1.8 * smaller && squared_norm(a.center - b.center) < 0.0625 * larger * larger;
}

// The surest of those that are fits to one landform. `found` is sorted by falling confidence.
std::vector<FoundFeature> surest(const std::vector<FoundFeature>& found) {
  std::vector<FoundFeature> kept;
  for (const FoundFeature& f : found) {
    if (std::none_of(kept.begin(), kept.end(), [&](const FoundFeature& k) { return are_one(f, k); }))
      kept.push_back(f);
  }
  return kept;
}

std::vector<FoundFeature> find_by_sign(const EvenedSurface& even, const SmoothingStep& step, BlobSign sign,
                                       double least_confidence, const Progress& progress) {
  const std::vector<SurfaceBlob> blobs = surface_blobs(even, step, sign, at_beginning(progress));
  const CraterFitter fitter(even, sign);
  const auto count = static_cast<std::int64_t>(kStarts.size() * blobs.size());
  std::vector<std::optional<CraterFit>> fits(static_cast<std::size_t>(count));
  reported_parallel_for({0, count, count}, progress, "fits of craters", [&](std::int64_t index) {
    const auto i = static_cast<std::size_t>(index);
    const SurfaceBlob& blob = blobs[i / kStarts.size()];
    fits[i] = fitter.fit(blob, kStarts[i % kStarts.size()] * blob.scale / kBlobPerRadius);
  });
  std::vector<FoundFeature> found;
  for (const std::optional<CraterFit>& fit : fits) {
    if (!fit || 2.0 * fit->radius < kLeastFound * even.edge) continue;
    const double confidence =
        crater_confidence(*fit, even.edge, sign == BlobSign::hollow ? kCraterWeights : kBoulderWeights);
    if (confidence >= least_confidence) found.push_back(make_feature(*fit, sign, confidence));
  }
  std::stable_sort(found.begin(), found.end(),
                   [](const FoundFeature& a, const FoundFeature& b) { return a.confidence > b.confidence; });
  return surest(found);
}

void check(const TriangleMesh& mesh, const FeatureOptions& options) {
  if (options.points != 0 && (options.points < kLeastPoints || options.points > kGreatestPoints))
    throw InputError("features: points must be 0, or 500 to 1000000");
  if (mesh.triangles.size() < kFewestTriangles)
    throw InputError("features: needs a mesh of 1000 triangles or more; this one has " +
                     std::to_string(mesh.triangles.size()));
}

}  // namespace

FoundFeatures find_features(const TriangleMesh& mesh, const FeatureOptions& options,
                            const Progress& progress) {
  check(mesh, options);
  FoundFeatures result;
  result.points = options.points > 0 ? options.points : own_points(mesh);
  const EvenedSurface even = even_surface(mesh, result.points, options.seed, at_beginning(progress));
  const SmoothingStep step(even);
  result.edge = even.edge;
  result.area = even.area;
  result.features = find_by_sign(even, step, BlobSign::hollow, options.least_confidence, progress);
  if (!options.boulders) return result;
  const std::vector<FoundFeature> boulders =
      find_by_sign(even, step, BlobSign::bump, options.least_confidence, progress);
  result.features.insert(result.features.end(), boulders.begin(), boulders.end());
  sort_by_confidence(result.features);
  return result;
}

}  // namespace astrolith
