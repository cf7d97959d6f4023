// Compares the connected components of a fit's surface with those of its target.
//
// A component of the fit belongs to the target's component that is nearest to most of its vertices, provided
// that both bound a body or both bound a cavity. The largest component that belongs to one of the target's is
// its counterpart. All others are strays: islands outside the body and cavities inside it. A component of the
// target without a counterpart is missing: the fit lost it, or joined it to another.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "estimation/shape/target/target_body.h"
#include "geometry/mesh_topology.h"
#include "geometry/triangle_mesh.h"

namespace astrolith {

// Connected components of a surface, and its handles (genus, summed over the components; -1 where the mesh
// has none).
struct PartsAndHandles {
  std::int64_t parts, handles;

  bool operator==(const PartsAndHandles&) const = default;
  std::string words() const;  // "1 part and 2 handles"
};

PartsAndHandles parts_and_handles(const TargetBody& target);
PartsAndHandles parts_and_handles(const MeshTopology& topology);

struct StrayComponent {
  bool cavity;    // a wall whose normals point inwards; otherwise an island
  Vec3d center;   // centre of its bounding box
  double radius;  // radius of the ball about `center` that holds its vertices
};

struct ComponentComparison {
  std::vector<StrayComponent> strays;  // largest volume first
  std::int64_t missing = 0;            // number of the target's components without a counterpart

  std::int64_t wrong() const { return missing + static_cast<std::int64_t>(strays.size()); }
};

// `fit` is closed and oriented, in the target's frame.
ComponentComparison compare_components(const TargetBody& target, const TriangleMesh& fit);

}  // namespace astrolith
