// What every program does with a file's triangles before it looks at them: triangles without common vertices
// become a surface, which faces outwards. Welding makes one vertex of the vertices at one place, and one face
// of the faces on the same vertices; winding turns faces consistently and outwards.
#pragma once

#include <cstdint>
#include <string>

#include "geometry/triangle_mesh.h"

namespace astrolith {

// Merges each vertex into the first kept vertex within tolerance * bounding-box diagonal. Tolerance 0 merges
// only vertices with equal coordinates. The kept vertices stay in their order and keep their normals. Faces
// are renumbered and never dropped, so that a face may name a vertex twice afterwards. Throws
// std::invalid_argument unless 0 <= tolerance < 0.1. Indices must be in range.
TriangleMesh weld_vertices(TriangleMesh mesh, double tolerance);

// Drops faces that name a vertex twice, and faces on the same three vertices as an earlier face, in the same
// winding or the other. All vertices stay.
TriangleMesh drop_degenerate_and_repeated_faces(TriangleMesh mesh);

// The vertices that faces use, in their order, without normals and colours.
TriangleMesh without_unused_vertices(const TriangleMesh& mesh);

// Winds neighbouring faces alike, as most of their component are, and turns closed components outwards that
// were inside out:
//   - a component that lies in no other has a positive volume afterwards;
//   - one inside another, such as the wall of a cavity, is turned where the outermost one around it is, and
//     keeps its sense otherwise.
// An open component counts as closed where its border is short: its square is below half the area. Others,
// such as patches of ground, keep the sense of most of their faces. Faces are neighbours across edges that
// exactly two faces share; a one-sided surface keeps a seam. Only the order of a face's vertices changes.
// Indices must be in range.
TriangleMesh orient_faces(TriangleMesh mesh);

struct WoundSurface {
  TriangleMesh mesh;
  // Vertices at one place that became one, and faces without an area that went with them; 0 where faces that
  // lie side by side share their vertices already.
  std::int64_t merged_vertices = 0;
  std::int64_t turned_faces = 0;

  bool changed() const { return merged_vertices > 0 || turned_faces > 0; }
  // "merged 12 vertices at equal places, turned 5 facets"; empty where nothing was done.
  std::string words() const;
};

// Winds the faces alike and outwards, as orient_faces does, and first merges vertices at equal places where
// that closes borders. A mesh that needs neither comes back as it is, otherwise without normals; merging
// drops colours too. Indices must be in range.
WoundSurface wound_surface(TriangleMesh mesh);

// Whether every edge has two faces wound alike, and every body faces outwards.
bool is_closed_body(const TriangleMesh& mesh);

// How many faces of `after` are wound otherwise than those of `before`, which has the same faces in the same
// order.
std::int64_t count_turned(const TriangleMesh& before, const TriangleMesh& after);

}  // namespace astrolith
