// Evenly spread points of a surface at one resolution, so that a triangulation is not mistaken for a surface,
// and the similarity of surfaces by their shape histograms.
#pragma once

#include <cstdint>
#include <vector>

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

struct EvenedSurface {
  std::vector<Vec3d> points;   // (n) the unit of the mesh
  std::vector<Vec3d> normals;  // (n) unit, outwards
  // (n) rms angle in radians between the normals of the mesh's facets within .5 edges of each point and
  // their mean, before anything is smoothed: 0 within a flat facet.
  std::vector<double> bends;
  // (n) the mean of the mesh around each point, by weights 1 - d^2 / (1.96 edge)^2, whose deviation is .8
  // edges. They lie a little beside the points.
  std::vector<Vec3d> means;
  double area = 0.0;  // of the mesh
  double edge = 0.0;  // evened_edge(area, n)
};

// Reach of these weights, edges, and the mean square distance that is theirs on a plane, squared edges.
inline constexpr double kMeanReach = 1.96, kMeanSquare = 1.28;

// The edge of equilateral triangles with n vertices that cover an area: 2 area = sqrt(3) n edge^2.
double evened_edge(double area, std::int64_t n);

// Spreads n points as a Poisson disk over the mesh. Each point then moves along its normal to the weighted
// mean height of the surface around it, with weights (1 - d^2 / (3.5 edge)^2)^3. The weights are near those
// of a Gaussian of deviation 1.4 edges: waves of 4, 6, 8 and 12 edges keep .17, .49, .68 and .84 of their
// height. A finer triangulation therefore adds nothing that a mesh of n vertices cannot have. Normals are
// weighted means of the normals of facets. Facets that look away from the point's own normal lie on another
// side of a thin body and do not count. Random places on the mesh, 5 a point, stand for the surface. Throws
// InputError as sample_surface() does and for a mesh that passes through itself so often that it is no
// surface, and WorkError when progress asks to stop.
EvenedSurface even_surface(const TriangleMesh& mesh, std::int64_t n, std::uint64_t seed,
                           const Progress& progress = {});

}  // namespace astrolith
