// Similarity of surfaces by shape histograms that their triangulations do not change.
#pragma once

#include <cstdint>

#include "descriptor/shape_description.h"
#include "geometry/triangle_mesh.h"
#include "numerics/progress.h"

namespace astrolith {

// Describes the points of even_surface(): what is finer than they lie apart does not count. Throws as
// even_surface() and describe_shape() do.
ShapeDescription describe_evened(const TriangleMesh& mesh, const DescriptionOptions& options,
                                 const StageProgress& progress = {});

// The options for sampling `which` of several that are compared: each has a seed of its own.
DescriptionOptions for_sampling(DescriptionOptions options, std::uint64_t which);

// Both are at most 1. A candidate above the floor cannot be told from the shape itself.
struct MeasuredSimilarity {
  double value = 0.0;  // of both shapes
  double floor = 0.0;  // of two samplings of the first
};

// What `compare` states of the same meshes with the same seed and its other defaults. Throws as
// describe_evened() does.
MeasuredSimilarity measure_similarity(const TriangleMesh& target, const TriangleMesh& candidate,
                                      std::uint64_t seed, const StageProgress& progress = {});

}  // namespace astrolith
