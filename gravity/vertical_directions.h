// The verticals of a body's surface, for work that needs no more than some tenths of a degree.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "geometry/triangle_mesh.h"

namespace astrolith {

struct CoarseSurface {
  TriangleMesh mesh;                // a vertex is the mean of the vertices in its cell; no normals
  std::vector<std::uint32_t> cell;  // for each vertex of the fine mesh, its vertex here
};

// The lattice has `cells` >= 1 cells along the longest side of the mesh's box. Facets whose corners lie in
// fewer than three cells vanish. The coarse mesh of a closed mesh is closed, and encloses about the same
// volume as long as the body is wider than a few cells; it may touch itself.
CoarseSurface coarse_surface(const TriangleMesh& mesh, int cells);

// The density and the rotation of a body.
struct BodyMotion {
  double density = 2000.0;      // kg / m^3, > 0
  double rotation_hours = 0.0;  // period about +z through the centre of mass; 0 = at rest
};

// For each vertex of a closed mesh the unit vector against gravity and centrifugal force, or the zero vector
// where the two cancel. Faces are counter-clockwise seen from outside.
//
// Gravity is that of a coarse mesh of the same volume, computed at its vertices and continued to the vertices
// of the mesh by its gradient. Hills smaller than 1/48 of the body therefore do not turn the verticals. On
// smooth bodies they are within 0.1 degrees of the truth on average, on rough ones within 0.7. Time grows
// with the vertices only by some 0.1 microseconds each. The bits are the same for any number of threads.
// Throws InputError for a mesh without a facet that has an area.
std::vector<Vec3d> vertical_directions(const TriangleMesh& mesh, const BodyMotion& motion);

// Verticals as above, at points on or near the surface of a closed mesh, with the gravity of the mesh itself,
// to some hundredths of a degree. Meant for meshes of some ten thousand facets: time grows with the points.
std::vector<Vec3d> vertical_directions_at(const TriangleMesh& mesh, std::span<const Vec3d> points,
                                          const BodyMotion& motion);

}  // namespace astrolith
