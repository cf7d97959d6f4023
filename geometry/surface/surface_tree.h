// Nearest points on a triangle mesh, and the signed distance to it.
#pragma once

#include <cstdint>
#include <memory>

#include "geometry/triangle_mesh.h"

namespace astrolith {

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
