// What a body looks like, by features of its shape.
#pragma once

#include "geometry/triangle_mesh.h"
#include "gravity/body_mass.h"
#include "recipe/population.h"

namespace astrolith {

// The features of a body in the frame of its principal axes, longest first.
struct ShapeFeatures {
  double elongation = 1.0;  // a / b of the half axes
  double flatness = 1.0;    // c / b
  // The least area of a cross-section across the longest axis between two larger ones, over the smaller of
  // these two: 1 without a waist.
  double waist = 1.0;
  // The mean distance from the shortest axis within 8 degrees of latitude, over that of the ellipsoid: above
  // 1 where a ridge lies about the equator.
  double ridge = 1.0;
};

// Where a closed body lies: half axes of the ellipsoid with its moments of inertia, and the unit vectors
// along them, a right-handed frame with the longest first.
struct BodyFrame {
  double volume;
  Vec3d center, half_axes;
  std::array<Vec3d, 3> axes;
};
BodyFrame body_frame(const TriangleMesh& mesh);

ShapeFeatures shape_features(const TriangleMesh& mesh, const BodyFrame& frame);

// contact_binary: waist below .8; top: ridge above 1.03 on a body whose equator is round within 15 %;
// elongated: elongation above 1.5; rounded: c / a above .75; fragment: all others.
BodyClass classify_body(const ShapeFeatures& features);

}  // namespace astrolith
