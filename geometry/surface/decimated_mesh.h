// Meshes of fewer vertices.
#pragma once

#include <cstddef>

#include "geometry/triangle_mesh.h"

namespace astrolith {

// Decimates by quadric error metrics (Garland and Heckbert 1997) with OpenMesh: collapses edges until at most
// `vertices` are left or none can be collapsed. The mesh is cut open wherever it is not an oriented manifold,
// which may add vertices. Throws InputError for indices out of range.
TriangleMesh decimated(const TriangleMesh& mesh, std::size_t vertices);

// Merges the vertices of each cubic cell (Rossignac and Borrel 1993) of a size that leaves about `vertices`,
// in the time of a sort. The mesh itself where it has no more. The result need not be a manifold.
TriangleMesh clustered(const TriangleMesh& mesh, std::size_t vertices);

}  // namespace astrolith
