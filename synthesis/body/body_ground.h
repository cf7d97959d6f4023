// The bare body as layers on the surface see it.
#pragma once

#include "synthesis/body/body_tables.h"

namespace astrolith {

// The body whose level sets give tangent frames, and the arrays that hold it.
struct BodyGround {
  const BodyTables& body;
  ArrayView arrays;
  LeafLists metaballs;            // all metaballs of the body
  const Vec3d* origin = nullptr;  // of the coordinates of a patch on a plain body; null: the body's own
};

}  // namespace astrolith
