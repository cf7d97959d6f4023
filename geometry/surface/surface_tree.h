// Nearest points on a triangle mesh, and the signed distance to it.
#pragma once

#include <cstdint>
#include <memory>

#include "geometry/triangle_mesh.h"

namespace astrolith {

struct ClosestPoint {
  Vec3d point;                 // on the surface
  std::uint32_t triangle = 0;  // the lowest index among those equally near
  double distance = 0;         // >= 0, in the mesh's unit
  // Angle-weighted pseudo-normal of the face, edge or vertex that point lies on: unit length, outwards; zero
  // where every triangle around has no area.
  Vec3d normal;
};

//   const SurfaceTree tree(mesh);
//   tree.signed_distance({0, 0, 0});   // from many threads at once, if you like
//
// Copies what it needs of the mesh. Boxes are searched in single precision by Embree's tree, with a margin
// that keeps every candidate; distances are computed in double precision, so results have full precision and
// do not depend on the machine's vector width.
class SurfaceTree {
 public:
  // Throws InputError for a mesh without triangles, with non-finite vertices or with indices out of range.
  explicit SurfaceTree(const TriangleMesh& mesh);
  SurfaceTree(SurfaceTree&&) noexcept;
  SurfaceTree& operator=(SurfaceTree&&) noexcept;
  ~SurfaceTree();

  // p must be finite.
  ClosestPoint closest(const Vec3d& p) const;

  // Positive inside, zero on the surface, negative outside, for closed, oriented and welded meshes; sign by
  // the pseudo-normal, which is right at edges and vertices too (Baerentzen and Aanaes 2005). Components that
  // overlap count as their union (a contact binary whose lobes reach into one another), up to 64 of them, all
  // wound outwards; walls buried in another component then bound nothing, and the distance inside the overlap
  // is the one to the farther component's wall, never too large. Where a cavity's wall is wound inwards,
  // components must not overlap.
  double signed_distance(const Vec3d& p) const;

 private:
  struct Body;
  struct State;
  std::unique_ptr<State> state_;
};

}  // namespace astrolith
