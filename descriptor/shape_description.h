// From a mesh, or points with normals, to the histogram that describes its shape.
//
//   const ShapeDescription eros = describe_shape(read_mesh("eros.ply"), {});
//   const ShapeDescription ida = describe_shape(read_mesh("ida.ply"), {});
//   double s = similarity(eros.histogram, ida.histogram);
#pragma once

#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include "descriptor/pair_count.h"
#include "descriptor/shape_histogram.h"
#include "geometry/triangle_mesh.h"
#include "numerics/progress.h"

namespace astrolith {

struct DescriptionOptions {
  PairFeatures features = PairFeatures::ahd;
  int bins = kDefaultBins;      // an axis, 2 to 10
  std::int64_t points = 10000;  // samples, 2 to 2^24; the time grows with their square
  std::uint64_t seed = 1;
  PairCounter count_pairs = {};  // empty: on the CPU
};

struct ShapeDescription {
  ShapeHistogram histogram;
  std::int64_t points = 0;                // that were looked at
  std::vector<std::string> remarks;       // "12 vertices without a curvature ...", for people
  std::int64_t vertices_left_out = 0;     // without a curvature: on boundaries, non-manifold, ...
  std::int64_t undefined_curvatures = 0;  // points whose kappa was taken as that of a plane
};

// Poisson-disk samples with their triangles' normals; kappa is the weighted mean within a fifth of the root
// mean square distance of the samples from their centre, so it does not depend on the triangles' size. Any
// mesh with an area will do. Throws InputError for options out of range and for a mesh without area,
// WorkError when progress asks to stop.
ShapeDescription describe_shape(const TriangleMesh& mesh, const DescriptionOptions& options,
                                const Progress& progress = {});

// From (n) points and (n) normals of any positive length alone. Points that repeat another are left out; of
// more points than asked for a random choice is taken, fewer are all taken; a remark says so. kappa by
// quadric fits (geometry/surface/sample_curvature.h). Throws InputError for fewer than two points, different
// sizes, and numbers that are not finite.
ShapeDescription describe_shape(std::span<const Vec3d> points, std::span<const Vec3d> normals,
                                const DescriptionOptions& options, const Progress& progress = {});

}  // namespace astrolith
