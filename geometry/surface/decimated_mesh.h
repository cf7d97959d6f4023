// Decimates meshes by quadric error metrics (Garland and Heckbert 1997) with OpenMesh.
#pragma once

#include <cstddef>

#include "geometry/triangle_mesh.h"

namespace astrolith {

// Collapses edges until at most `vertices` are left or none can be collapsed. The mesh is cut open wherever
// it is not an oriented manifold, which may add vertices. Throws InputError for indices out of range.
TriangleMesh decimated(const TriangleMesh& mesh, std::size_t vertices);

}  // namespace astrolith
