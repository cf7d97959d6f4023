// Measures how well candidates for the details reproduce a target, without meshing the candidates.
//
//   fitness = (1 - similarity(H_target, H_candidate)) + kRoughnessWeight * roughness_misfit
//             + max(0, steepness - kSteepest)
// The fitness has no unit, is at least 0, and is best when it is least. H are histograms of the adaptive
// hybrid descriptor. The base is meshed once, about as finely as the target. For a candidate the vertices of
// this mesh move along the base's normals to the candidate's surface. Each sample of the target has its
// nearest place on this mesh, which moves with its triangle. Normals and curvatures of both histograms are
// therefore taken in the same way, and the histograms differ by the shapes and not by the sampling.
//
// A histogram with five bins for each axis shows how steep details are, but hardly how wide. The roughness
// (roughness.h) adds the width. It is computed from heights over the base, so it leaves out what the base
// fits already.
#pragma once

#include <algorithm>
#include <cstdint>
#include <span>
#include <vector>

#include "descriptor/surflet_histogram.h"
#include "estimation/shape/details/detail_parameters.h"
#include "estimation/shape/details/surface_probe.h"
#include "geometry/surface/mesh_sampling.h"
#include "geometry/triangle_mesh.h"

namespace astrolith {

// A mesh whose vertices move while its triangles and the samples on them stay, and the adaptive hybrid
// descriptor of these samples (descriptor/shape_description.h). What does not change is computed once.
class MovedMesh {
 public:
  // `mesh` is the closed manifold mesh before any vertex moves. The curvature of a sample is the weighted
  // mean over the vertices within `radius`, in the mesh's unit, as in geometry/surface/sample_curvature.h.
  // These vertices and their weights stay the same when vertices move.
  MovedMesh(const TriangleMesh& mesh, const std::vector<MeshPlace>& samples, double radius);

  // The features of the samples for vertices at these places, from which pairs are counted.  (#V in)
  PairInput pair_input(const std::vector<Vec3d>& vertices) const;
  // The histogram of these pairs.  (#V in)
  ShapeHistogram histogram(const std::vector<Vec3d>& vertices) const;

 private:
  struct Neighbour {
    std::uint32_t vertex;
    float weight;
  };
  void add_neighbours(const TriangleMesh& mesh, const std::vector<Vec3d>& normals, const MeshPlace& sample,
                      double radius);

  std::vector<Triangle> triangles_;
  std::vector<MeshPlace> samples_;
  std::vector<Neighbour> neighbours_;
  std::vector<std::size_t> first_neighbour_{0};  // (#samples + 1)
};

// A roughness from a few thousand lines has an error of about 2 %, and a similarity of a few thousand samples
// one of about 1 %. With a weight of one half both errors change the fitness by the same amount.
inline constexpr double kRoughnessWeight = 0.5;

// Moving vertices find the surface nearest to the base and miss islands beyond it. Details that are steep
// enough to make islands are therefore penalised. The steepness is an upper bound that details seldom reach,
// so the limit is above 1.
inline constexpr double kSteepest = 1.5;

struct FitnessOptions {
  std::int64_t samples = 4000;    // of the histogram; the cost of a fitness grows with the square
  int lines = 2000;               // of the roughness
  std::uint64_t seed = 1;         // of samples and lines
  std::uint64_t recipe_seed = 1;  // of the noises
};

struct DetailScore {
  double similarity = 0.0;        // at most 1
  double roughness_misfit = 0.0;  // roughness.h
  double steepness = 0.0;         // detail_parameters.h
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

  // The scores of all candidates, which the evaluator computes in a few launches. They have the bits that
  // score gives for each.
  std::vector<DetailScore> scores(std::span<const std::vector<FractalLayer>> candidates,
                                  CandidateEvaluator& evaluator) const;

  // The ranges of the search, which follow from the target's resolution and roughness.
  const DetailRanges& ranges() const { return ranges_; }

  const std::vector<double>& lags() const { return layout_.lags; }
  const std::vector<double>& target_roughness() const { return wanted_roughness_; }  // (#lags)
  // The roughness of the layers' heights over the base.  (#lags)
  std::vector<double> layers_roughness(std::span<const FractalLayer> layers) const;

 private:
  void leave_out_strays(const std::vector<double>& heights);
  std::vector<Vec3d> moved_vertices(const std::vector<double>& heights) const;
  ShapeHistogram histogram(const std::vector<double>& heights) const;
  DetailScore detail_score(const ShapeHistogram& histogram, const std::vector<double>& heights,
                           std::span<const FractalLayer> layers) const;

  FitnessOptions options_;
  ProbeLayout layout_;
  SurfaceProbe probe_;
  SurfaceSamples samples_;  // of the target, for the histograms
  MovedMesh mesh_;
  ShapeHistogram wanted_histogram_;
  std::vector<double> wanted_roughness_;
  DetailRanges ranges_;
};

}  // namespace astrolith
