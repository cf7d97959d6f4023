#include "descriptor/surface/evened_similarity.h"

#include "descriptor/histogram_distance.h"
#include "descriptor/surface/evened_surface.h"

namespace astrolith {

ShapeDescription describe_evened(const TriangleMesh& mesh, const DescriptionOptions& options,
                                 const StageProgress& progress) {
  const auto stage = [&](const char* name) { return progress ? progress(name) : Progress(); };
  const EvenedSurface even = even_surface(mesh, options.points, options.seed, stage("even"));
  return describe_shape(even.points, even.normals, options, stage("describe"));
}

DescriptionOptions for_sampling(DescriptionOptions options, std::uint64_t which) {
  options.seed += which * 0x9e3779b97f4a7c15u;
  return options;
}

MeasuredSimilarity measure_similarity(const TriangleMesh& target, const TriangleMesh& candidate,
                                      std::uint64_t seed, const StageProgress& progress) {
  DescriptionOptions options;
  options.seed = seed;
  const auto histogram = [&](const TriangleMesh& mesh, std::uint64_t which) {
    return describe_evened(mesh, for_sampling(options, which), progress).histogram;
  };
  const ShapeHistogram wanted = histogram(target, 0);
  return {similarity(wanted, histogram(candidate, 1)), similarity(wanted, histogram(target, 2))};
}

}  // namespace astrolith
