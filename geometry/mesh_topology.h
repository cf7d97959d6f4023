// Topology of a mesh, counted from its index arrays alone. It works on any input, also where no half-edge
// structure could hold the mesh. Also the connected parts of a surface, and how they lie to one another.
#pragma once

#include <cstdint>
#include <vector>

#include "geometry/triangle_mesh.h"

namespace astrolith {

struct SurfacePart {
  TriangleMesh mesh;  // the vertices that the part uses, in their order of use
  Box box;
  double volume = 0.0;  // signed
};

// Splits a mesh by `number`, (#F) the part of each face, from 0 without gaps.
std::vector<SurfacePart> split_parts(const TriangleMesh& mesh, const std::vector<std::uint32_t>& number);

// Whether all of the inner box lies in the outer one.
bool box_holds(const Box& outer, const Box& inner);

// Answers whether parts lie inside one another, by winding numbers at places of their surfaces. The work is
// bounded: 2e8 solid angles of triangles in all.
class PartNesting {
 public:
  // The share of the surface of `a`, of what lies in the box of `b` alone, that lies inside `b`; 0 where
  // nothing does. Places on the surface of `b` do not count. Up to 64 faces of `a` are looked at, those of
  // meshes with few faces at more places than one.
  double share_inside(const SurfacePart& a, const SurfacePart& b);
  // Whether `a` lies in the box of `b`, and all places that are looked at inside `b`.
  bool lies_inside(const SurfacePart& a, const SurfacePart& b);
  // Whether the work is spent; every answer from then on is 0 or false.
  bool spent() const { return angles_left_ < 0.0; }

 private:
  double angles_left_ = 2e8;
};

struct MeshTopology {
  std::int64_t boundary_edges = 0;         // edges of one triangle
  std::int64_t non_manifold_edges = 0;     // edges of three or more triangles
  std::int64_t non_manifold_vertices = 0;  // vertices whose triangles are not one disk or half disk
  std::int64_t misoriented_edges = 0;      // edges not run through equally often both ways
  std::int64_t degenerate_triangles = 0;   // triangles that name a vertex twice; no other count has them
  std::int64_t unused_vertices = 0;        // vertices of no triangle; no other count has them
  std::int64_t components = 0;             // connected through shared vertices
  std::int64_t euler_characteristic = 0;   // V - E + F
  std::int64_t genus = -1;                 // sum over components; -1 unless closed, manifold and oriented
  bool closed = false;                     // has triangles and no boundary edges
  bool manifold = false;  // has triangles, and no non-manifold edges or vertices; may be open
  bool oriented = false;  // has no misoriented edges
};

// Counts everything above. Throws InputError for an index that is not below the number of vertices. Takes
// time O(F log F).
MeshTopology analyze_topology(const TriangleMesh& mesh);

// (#F) the component that each triangle belongs to, numbered from 0 in the order of the components' first
// triangles. Indices must be in range.
std::vector<std::uint32_t> triangle_components(const TriangleMesh& mesh);

}  // namespace astrolith
