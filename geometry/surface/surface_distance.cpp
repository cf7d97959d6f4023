#include "geometry/surface/surface_distance.h"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <vector>

#include "geometry/surface/mesh_sampling.h"
#include "numerics/errors.h"
#include "numerics/reported_loop.h"
#include "numerics/sample_statistics.h"

namespace astrolith {
namespace {

std::vector<double> distances(const TriangleMesh& from, const SurfaceTree& to, std::int64_t samples,
                              std::uint64_t seed, const Progress& progress) {
  const SurfaceSamples points = sample_surface(from, samples, seed, SampleNormals::triangle, progress);
  std::vector<double> result(points.points.size());
  reported_parallel_for({0, samples, samples}, progress, "distances", [&](std::int64_t i) {
    const auto k = static_cast<std::size_t>(i);
    result[k] = to.closest(points.points[k]).distance;
  });
  return result;
}

DistanceFigures figures(std::vector<double> d) {
  const double count = static_cast<double>(d.size());
  DistanceFigures f;
  f.mean = std::accumulate(d.begin(), d.end(), 0.0) / count;
  f.max = *std::max_element(d.begin(), d.end());
  f.p99 = ranked_value(std::move(d), static_cast<std::size_t>(std::ceil(0.99 * count)) - 1);
  return f;
}

}  // namespace

SurfaceDistanceReport surface_distance(const TriangleMesh& a, const TriangleMesh& b, std::int64_t samples,
                                       std::uint64_t seed, const Progress& progress) {
  return surface_distance(a, SurfaceTree(a), b, SurfaceTree(b), samples, seed, progress);
}

SurfaceDistanceReport surface_distance(const TriangleMesh& a, const SurfaceTree& tree_a,
                                       const TriangleMesh& b, const SurfaceTree& tree_b, std::int64_t samples,
                                       std::uint64_t seed, const Progress& progress) {
  if (samples <= 0) throw InputError("surface distance: needs at least one sample");
  std::vector<double> both = distances(a, tree_b, samples, seed, progress);
  const std::vector<double> back = distances(b, tree_a, samples, seed, progress);
  SurfaceDistanceReport report;
  report.from_a_to_b = figures(both);
  report.from_b_to_a = figures(back);
  both.insert(both.end(), back.begin(), back.end());
  const DistanceFigures all = figures(std::move(both));
  report.mean = all.mean;
  report.p99 = all.p99;
  report.max = all.max;
  return report;
}

}  // namespace astrolith
