// Makes the histogram that describes a shape from a mesh, or from points with normals.
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
  int bins = kDefaultBins;      // along each axis, 2 to 10
  std::int64_t points = 10000;  // samples, 2 to 2^24; the time grows with their square
  std::uint64_t seed = 1;
  PairCounter count_pairs = {};  // empty: count_pairs on the CPU
};

struct ShapeDescription {
  ShapeHistogram histogram;
  std::int64_t points = 0;                // number of points examined
  std::vector<std::string> remarks;       // for people: "12 vertices ... have no curvature ..."
  std::int64_t vertices_left_out = 0;     // vertices without a curvature: on boundaries, ...
  std::int64_t undefined_curvatures = 0;  // points that count as flat, for want of a curvature
};

// Describes Poisson-disk samples of the mesh with the normals of their triangles. kappa is a weighted mean of
// the curvature in a ball, whose radius is a fifth of the root mean square distance of the samples from their
// centre. It therefore does not depend on the size of the triangles. Any mesh with an area will do. Throws
// InputError for options out of range and for a mesh without area, and WorkError when progress asks to stop.
ShapeDescription describe_shape(const TriangleMesh& mesh, const DescriptionOptions& options,
                                const Progress& progress = {});

// Describes (n) points with (n) normals of any positive length. Points that repeat another are left out. Of
// more points than asked for a random choice is taken; of fewer all are taken, and a remark says so. kappa
// comes from fits of quadrics (geometry/surface/sample_curvature.h). Throws InputError for fewer than two
// points, different sizes, and numbers that are not finite.
ShapeDescription describe_shape(std::span<const Vec3d> points, std::span<const Vec3d> normals,
                                const DescriptionOptions& options, const Progress& progress = {});

}  // namespace astrolith
