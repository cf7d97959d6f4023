// Area, volume and centroids of triangle meshes, in the mesh's own unit.
#pragma once

#include "geometry/triangle_mesh.h"

namespace astrolith {

double triangle_area(const TriangleMesh& mesh, const Triangle& triangle);

double surface_area(const TriangleMesh& mesh);

// The edge of as many equilateral triangles of the same area. Expects a triangle.
double mean_edge(const TriangleMesh& mesh);

// The signed volume: positive for a closed mesh whose faces are counter-clockwise seen from outside. For an
// open mesh it is the volume of the cone over the centre of the bounding box, and depends on that choice.
double volume(const TriangleMesh& mesh);

// The centre of mass of the solid at constant density. The centre of the bounding box when the volume is
// zero.
Vec3d volume_centroid(const TriangleMesh& mesh);

// The centre of mass of the surface at constant density. The centre of the bounding box when the area is
// zero.
Vec3d surface_centroid(const TriangleMesh& mesh);

}  // namespace astrolith
