// The quality of triangles: 4 sqrt(3) area / (sum of the squares of the edges). It is 1 for an equilateral
// triangle and 0 for one without area.
#pragma once

#include <span>

#include "geometry/mesh_sink.h"

namespace astrolith {

float triangle_quality(const Vec3f& a, const Vec3f& b, const Vec3f& c);

struct QualityFigures {
  double first_percentile = 0.0;  // one triangle in a hundred is worse
  double mean = 0.0;
};

// The figures of a mesh; both are 0 for a mesh without triangles. Indices must be in range.
QualityFigures quality_of(std::span<const MeshVertex> vertices, std::span<const Triangle> triangles);

}  // namespace astrolith
