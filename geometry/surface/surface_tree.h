// Nearest points on a triangle and on a triangle mesh, and the signed distance to it.
#pragma once

#include <cstdint>
#include <memory>

#include "geometry/triangle_mesh.h"
#include "numerics/vec3.h"

namespace astrolith {

enum class TriangleFeature : std::uint8_t { corner_a, corner_b, corner_c, side_ab, side_bc, side_ca, face };

struct ClosestOnTriangle {
  Vec3d point;
  double squared_distance = 0;
  TriangleFeature feature = TriangleFeature::face;
};

// The point of triangle a b c nearest to p. The triangle may have shrunk to a segment or a point. The test
// follows the Voronoi regions of the triangle (Ericson, Real-Time Collision Detection, 2005, section 5.1.5).
ClosestOnTriangle closest_on_triangle(const Vec3d& p, const Vec3d& a, const Vec3d& b, const Vec3d& c);

struct ClosestPoint {
  Vec3d point;                 // on the surface
  std::uint32_t triangle = 0;  // lowest index among equally near triangles
  double distance = 0;         // >= 0, in the mesh's unit
  // The angle-weighted pseudo-normal of the face, edge or vertex that `point` lies on: unit length, outwards.
  // It is zero where no triangle around `point` has an area.
  Vec3d normal;
};

//   const SurfaceTree tree(mesh);
//   tree.signed_distance({0, 0, 0});   // any number of threads may query one tree
//
// The tree copies what it needs of the mesh. Embree searches boxes in single precision, with a margin that
// keeps every candidate. Distances to the candidates are computed in double precision. Results therefore have
// full precision and do not depend on the vector width of the machine.
class SurfaceTree {
 public:
  // Throws InputError for a mesh without triangles, with vertices that are not finite or with indices out of
  // range, and for a garbled one, in which searches would have to look at hundreds of triangles. Throws
  // WorkError when Embree does not start or runs out of memory.
  explicit SurfaceTree(const TriangleMesh& mesh);
  SurfaceTree(SurfaceTree&&) noexcept;
  SurfaceTree& operator=(SurfaceTree&&) noexcept;
  ~SurfaceTree();

  // The point of the surface nearest to p, which must be finite.
  ClosestPoint closest(const Vec3d& p) const;

  // The distance of p from the surface: positive inside, zero on the surface, negative outside. The mesh must
  // be closed, oriented and welded. The pseudo-normal decides the sign, which is right at edges and vertices
  // too (Baerentzen and Aanaes 2005). Up to 64 components that overlap, all wound outwards, count as their
  // union: a contact binary whose lobes reach into one another. A wall inside another component then bounds
  // nothing. Inside the overlap the result is the distance to the wall of the farther component, which is
  // never too large. Where the wall of a cavity is wound inwards, components must not overlap.
  double signed_distance(const Vec3d& p) const;

 private:
  struct Body;
  struct State;
  std::unique_ptr<State> state_;
};

}  // namespace astrolith
