// Area, volume, centroids and unit normals of triangle meshes, in the mesh's own unit. Normals point out of a
// mesh whose faces are counter-clockwise from outside. Also the winding number of a closed mesh about a
// point, and the quality of triangles: 4 sqrt(3) area / (sum of the squares of the edges). The quality is 1
// for an equilateral triangle and 0 for one without area.
#pragma once

#include <span>
#include <vector>

#include "geometry/mesh_sink.h"
#include "geometry/triangle_mesh.h"

namespace astrolith {

// The unit normal of a triangle; zero for a triangle without area.
Vec3d triangle_normal(const TriangleMesh& mesh, const Triangle& triangle);

// (#F) unit normals.
std::vector<Vec3d> triangle_normals(const TriangleMesh& mesh);

// (#V) unit normals: triangle normals averaged with the angle at the vertex as weight. The average does not
// depend on how the surface is cut into triangles. A vertex without triangles of an area has the normal zero.
// These are also the pseudo-normals that decide between inside and outside (Baerentzen and Aanaes, "Signed
// distance computation using the angle weighted pseudonormal", IEEE TVCG 2005).
std::vector<Vec3d> vertex_normals(const TriangleMesh& mesh);

float triangle_quality(const Vec3f& a, const Vec3f& b, const Vec3f& c);

struct QualityFigures {
  double first_percentile = 0.0;  // one triangle in a hundred is worse
  double mean = 0.0;
};

// The figures of a mesh; both are 0 for a mesh without triangles. Indices must be in range.
QualityFigures mesh_quality(std::span<const MeshVertex> vertices, std::span<const Triangle> triangles);

// For a closed oriented mesh: 1 inside, 0 outside, 2 where two bodies overlap, -1 inside a body that is
// inside out. It is the sum of the solid angles of all triangles as seen from p, over 4 pi (Van Oosterom and
// Strackee, "The solid angle of a plane triangle", 1983). It is undefined on the surface.
double winding_number(const TriangleMesh& mesh, const Vec3d& p);

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
