// The mean plane of a piece of ground, over which maps have their heights.
#pragma once

#include <optional>

#include "geometry/surface/ground_axes.h"
#include "geometry/triangle_mesh.h"

namespace astrolith {

// A plane across `axes.up`, and the place on it that maps have in their middle.
struct GroundPlane {
  GroundAxes axes;
  Vec3d origin;
};

// The mean plane of an open piece of surface: through its centroid, across its mean_normal(). None where the
// normals cancel, as they do on a closed mesh, and for a mesh without area.
std::optional<GroundPlane> mean_plane(const TriangleMesh& mesh);

}  // namespace astrolith
