// What every program does with a file's triangles before it looks at them: triangles without common vertices
// become a surface, which faces outwards.
#pragma once

#include <cstdint>
#include <string>

#include "geometry/triangle_mesh.h"

namespace astrolith {

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
