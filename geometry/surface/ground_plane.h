// The mean plane of a piece of ground, over which maps have their heights, and its axes: across the
// plane, and up.
#pragma once

#include <optional>

#include "geometry/triangle_mesh.h"

namespace astrolith {

// Orthonormal and right-handed: right x ahead = up.
struct GroundAxes {
  Vec3d right{1, 0, 0}, ahead{0, 1, 0}, up{0, 0, 1};

  // A vector given along right, ahead and up, in the frame of the axes.
  ASTROLITH_HD Vec3d to_frame(const Vec3d& v) const { return v.x * right + v.y * ahead + v.z * up; }
};

// The axes about a unit vector: +z leans ahead, or +x where up is along z.
GroundAxes axes_about(const Vec3d& up);

// The mean normal of the triangles, weighted by their areas: of an open piece of surface the normal of its
// mean plane. A unit vector, or 0 where the normals cancel, as they do on a closed mesh.
Vec3d mean_normal(const TriangleMesh& mesh);

// A plane across `axes.up`, and the place on it that maps have in their middle.
struct GroundPlane {
  GroundAxes axes;
  Vec3d origin;
};

// The mean plane of an open piece of surface: through its centroid, across its mean_normal(). None where the
// normals cancel, as they do on a closed mesh, and for a mesh without area.
std::optional<GroundPlane> mean_plane(const TriangleMesh& mesh);

}  // namespace astrolith
