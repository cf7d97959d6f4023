// Measures how like a target's surface that of a candidate is: the candidate's recipe is meshed, and the
// statistics of both surfaces are compared (descriptor/surface).
//
//   distance = sqrt(mean of squared distances + 0.5 * largest squared distance) + penalty
// over the statistics that the search sees: roughness, skewness and normals within 3, 6 and 12 edges, the
// correlations of roughness over distance (a quarter of their difference), and the variance of roughness
// between regions. The kurtosis is held out: it judges what the search has found. The penalty grows with the
// components and the handles that the candidate has beyond those of the target.
#pragma once

#include <cstdint>
#include <map>
#include <vector>

#include "descriptor/shape_histogram.h"
#include "descriptor/surface/surface_statistics.h"
#include "estimation/shape/target/target_body.h"
#include "numerics/progress.h"
#include "recipe/recipe.h"

namespace astrolith {

struct CandidateOptions {
  std::int64_t most_points = 16000;  // that both surfaces are evened to, 500 to 60,000
  std::int64_t places = 1500;        // 100 to 20,000
  std::uint64_t seed = 1;            // of the sampling
};

struct CandidateFigures {
  double distance = 0.0;  // of the search
  double held_out = 0.0;  // mean distance of the held-out statistics, 0 to 1
  double variance_ratio =
      0.0;  // of roughness between regions, candidate over target; 0 where the target has none
  // The medians of the logarithm of roughness, candidate less target, by the radius in edges.
  std::map<double, double> rougher;
  double skewness_lack = 0.0;  // mean skewness within 3 and 6 edges, target less candidate
  double similarity = 0.0;     // of the shape histograms (ahd); only where it was asked for
  std::int64_t components = 0, genus = 0;
};

class CandidateMeasure {
 public:
  // `base` is the recipe of the body without layers, in the file's frame. Throws as surface_statistics()
  // does.
  CandidateMeasure(const TargetBody& target, const Recipe& base, const CandidateOptions& options,
                   const Progress& progress = {});

  // The figures of the base with layers. A `draw` above 0 takes another seed of the noise, and samples both
  // surfaces anew for the histogram. Throws WorkError when progress asks to stop.
  CandidateFigures figures(const std::vector<Layer>& layers, int draw, bool with_similarity,
                           const Progress& progress = {}) const;

  // Adds a group of metaballs, which layers may be tied to, to the base.
  void add_group(const SphereGroup& group) { base_.body->groups.push_back(group); }

  const SurfaceStatistics& target_statistics() const { return wanted_; }
  // The edge of the evened target in the unit of the recipe, and points over it.
  double edge() const { return wanted_.edge * target_.diagonal; }
  const Recipe& base() const { return base_; }

 private:
  TriangleMesh mesh_of(const Recipe& recipe, const Progress& progress) const;
  SurfaceStatistics statistics_of(const TriangleMesh& mesh, std::uint64_t seed,
                                  const Progress& progress) const;
  double similarity_with(const TriangleMesh& mesh, int draw, const Progress& progress) const;

  const TargetBody& target_;
  Recipe base_;
  CandidateOptions options_;
  SurfaceStatistics wanted_;
  std::int64_t wanted_genus_ = 0;
  int resolution_ = 64;
};

}  // namespace astrolith
