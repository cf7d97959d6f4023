// The topology that a fit should have from its target.
#pragma once

#include <cstdint>
#include <string>

#include "estimation/shape/target/target_body.h"
#include "geometry/mesh_topology.h"

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

}  // namespace astrolith
