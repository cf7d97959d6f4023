// The connected parts of a surface, and how they lie to one another.
#pragma once

#include <cstdint>
#include <vector>

#include "geometry/triangle_mesh.h"

namespace astrolith {

struct MeshPart {
  TriangleMesh mesh;  // the vertices that the part uses, in their order of use
  Box box;
  double volume = 0.0;  // signed
};

// Splits a mesh by `number`, (#F) the part of each face, from 0 without gaps.
std::vector<MeshPart> parts_of(const TriangleMesh& mesh, const std::vector<std::uint32_t>& number);

// Whether all of the inner box lies in the outer one.
bool box_holds(const Box& outer, const Box& inner);

// Answers whether parts lie inside one another, by winding numbers at places of their surfaces. The work is
// bounded: 2e8 solid angles of triangles in all.
class PartNesting {
 public:
  // The share of the surface of `a`, of what lies in the box of `b` alone, that lies inside `b`; 0 where
  // nothing does. Places on the surface of `b` do not count. Up to 64 faces of `a` are looked at, those of
  // meshes with few faces at more places than one.
  double share_inside(const MeshPart& a, const MeshPart& b);
  // Whether `a` lies in the box of `b`, and all places that are looked at inside `b`.
  bool lies_inside(const MeshPart& a, const MeshPart& b);
  // Whether the work is spent; every answer from then on is 0 or false.
  bool spent() const { return angles_left_ < 0.0; }

 private:
  double angles_left_ = 2e8;
};

}  // namespace astrolith
