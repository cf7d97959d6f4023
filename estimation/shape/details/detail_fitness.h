// How well candidates for the details reproduce a target, without meshing them.
//
//   fitness = (1 - similarity(H_target, H_candidate)) + kRoughnessWeight * roughness_misfit
//             + max(0, steepness - kSteepest)
// H are histograms of the adaptive hybrid descriptor. The base is meshed once, about as finely as the target;
// for a candidate the vertices of that mesh move along the base's normals to the candidate's surface, and the
// samples, which lie where the target's own samples are nearest, move with their triangles. So normals and
// curvatures mean the same on both sides, and what the histograms differ by is the shapes, not the sampling.
// Five bins an axis see how steep details are, hardly how wide: the roughness (roughness.h) adds that. It is
// of heights over the base, so what the base fits already is not asked for twice.
#pragma once

#include <algorithm>
#include <cstdint>
#include <span>
#include <vector>

#include "estimation/shape/details/detail_parameters.h"
#include "estimation/shape/details/moved_mesh.h"
#include "estimation/shape/details/probe_layout.h"
#include "geometry/surface/mesh_sampling.h"

namespace astrolith {

// A roughness from some thousand lines is known to about 2 %, a similarity of some thousand samples to about
// 1 %: both count alike for what they are worth when the weight is about a half.
inline constexpr double kRoughnessWeight = 0.5;

// Vertices that move find the surface nearest to the base and see no islands beyond it, so details that may
// make some are kept away. Bounds of slopes are seldom met, and never by all octaves in one place.
inline constexpr double kSteepest = 1.5;

struct FitnessOptions {
  std::int64_t samples = 4000;    // of the histogram; a fitness costs the square of it
  int lines = 2000;               // for the roughness
  std::uint64_t seed = 1;         // of both
  std::uint64_t recipe_seed = 1;  // of the noises
};

struct DetailScore {
  double similarity = 0.0;
  double roughness_misfit = 0.0;
  double steepness = 0.0;
  double fitness() const {
    return 1.0 - similarity + kRoughnessWeight * roughness_misfit + std::max(0.0, steepness - kSteepest);
  }
};

class DetailFitness {
 public:
  // `base` is in the target's frame.
  DetailFitness(const TargetBody& target, const MetaballBody& base, const FitnessOptions& options);

  // May be called from many threads. The layers are in the target's frame.
  DetailScore score(std::span<const FractalLayer> layers) const;

  // The same of a whole swarm, in a few launches of a machine: the same bits.
  std::vector<DetailScore> scores(std::span<const std::vector<FractalLayer>> candidates,
                                  CandidateEvaluator& evaluator) const;

  // Of the search, by what the target shows.
  const DetailRanges& ranges() const { return ranges_; }

  const std::vector<double>& lags() const { return layout_.lags; }
  const std::vector<double>& target_roughness() const { return wanted_roughness_; }  // of each lag
  // Of heights over the base.
  std::vector<double> layers_roughness(std::span<const FractalLayer> layers) const;

 private:
  void leave_out_strays(std::span<const double> heights);
  std::vector<Vec3d> moved_vertices(const std::vector<double>& heights) const;
  ShapeHistogram histogram(const std::vector<double>& heights) const;
  DetailScore score_of(const ShapeHistogram& histogram, const std::vector<double>& heights,
                       std::span<const FractalLayer> layers) const;

  FitnessOptions options_;
  ProbeLayout layout_;
  SurfaceProbe probe_;
  SurfaceSamples samples_;  // of the target: where the histogram is taken
  MovedMesh mesh_;
  ShapeHistogram wanted_histogram_;
  std::vector<double> wanted_roughness_;
  DetailRanges ranges_;
};

}  // namespace astrolith
