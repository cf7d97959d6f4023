// Thermal erosion of a mesh (Musgrave et al. 1989; thesis eq. 5.12): where a neighbour lies lower than the
// talus angle allows, material slides down to it.
//
// Vertices move along their own vertical, the direction against local gravity. Along it a vertex v changes
// the volume by a_v per unit of height, where a_v is a third of its faces' area as the vertical sees it, and
// stays what it is while neighbours move along theirs. An edge from v down to u that is too high by e, at its
// horizontal length l,
//   e = (h_v - h_u) - l tan T > 0,
// lets the volume c e / (1/a_v + 1/a_u) pass from v to u (with c = 1 the edge would then be at the talus
// angle). Edges take their turns in the mesh's order until none is too high. The surface stays a graph over
// the horizontal wherever it was one, so that it cannot run into itself; vertices under overhangs and on
// walls, of which a face leans over or stands within 5 degrees of the vertical, are rock and stay.
#pragma once

#include <cstdint>
#include <span>

#include "geometry/triangle_mesh.h"
#include "numerics/progress.h"

namespace astrolith {

struct ErosionStatistics {
  std::int64_t moved_vertices = 0;
  std::int64_t rock_vertices = 0;  // that could not move
  int sweeps = 0;
  bool settled = false;          // no slope above the talus angle was left, before the sweeps were used up
  double steepest_before = 0.0;  // slope of an edge between vertices that can move, degrees
  double steepest_after = 0.0;
  double volume_moved = 0.0;  // cubic length units
};

// Erodes a closed mesh in place; `up` holds a unit vector or zero (rock) for each vertex. The volume stays
// the same; normals, where the mesh has them, become those of the new surface around what moved. Talus angle
// in degrees, (0, 89]; serial and in the mesh's order, so that the result depends on nothing else. Throws
// InputError for other angles, WorkError when progress asks to stop.
ErosionStatistics erode(TriangleMesh& mesh, std::span<const Vec3d> up, double talus_degrees, int most_sweeps,
                        const Progress& progress = {});

}  // namespace astrolith
