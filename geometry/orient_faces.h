// Winds the faces of a mesh consistently and outwards.
#pragma once

#include "geometry/triangle_mesh.h"

namespace astrolith {

// Winds neighbouring faces alike, as most of their component are, and turns closed components outwards that
// were inside out:
//   - a component that lies in no other has a positive volume afterwards;
//   - one inside another, such as the wall of a cavity, is turned where the outermost one around it is, and
//     keeps its sense otherwise.
// An open component counts as closed where its border is short: its square is below half the area. Others,
// such as patches of ground, keep the sense of most of their faces. Faces are neighbours across edges that
// exactly two faces share; a one-sided surface keeps a seam. Only the order of a face's vertices changes.
// Indices must be in range.
TriangleMesh orient_faces(TriangleMesh mesh);

}  // namespace astrolith
