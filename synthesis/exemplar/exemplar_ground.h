// The surface that an exemplar layer lies on: the body with the layers below the exemplar.
#pragma once

#include "synthesis/body/layer_site.h"
#include "synthesis/gabor/gabor_cells.h"

namespace astrolith {

struct ExemplarGround {
  const BodyGround& body;
  FieldBelow below = {};      // empty where no layer below makes an elevation
  double height_bound = 0.0;  // bound of the |elevation| of the layers below, length units
};

// A vector towards the inside, along the normal of the plane that fits the layered surface best above or
// below a point near the bare surface. `inward` points towards the inside of the bare body there. The plane
// fits the field at 16 points over two rings of `radius` and half of it, parallel to the bare tangent plane.
Vec3f layered_inward(const ExemplarGround& ground, const Vec3f& foot, const Vec3f& inward, float radius);

// A tangent frame of the bare surface, turned by the least angle after which its normal points against
// `inward`. The normals must be less than half a turn apart.
TangentFrame turned_frame(const TangentFrame& bare, const Vec3f& inward);

}  // namespace astrolith
