// Thermal erosion of a mesh (Musgrave et al. 1989; thesis eq. 5.12): where a neighbour lies lower than the
// talus angle T allows, material slides down to it.
//
// Each vertex moves along its own vertical, the direction against local gravity. A vertex v that moves by a
// unit of height changes the volume by a_v, a third of the area of its faces as seen along the vertical. a_v
// stays the same while neighbours move along their verticals. An edge from v down to u of horizontal length l
// is too high by
//   e = (h_v - h_u) - l tan T > 0.
// It lets the volume c e / (1/a_v + 1/a_u) pass from v to u; with c = 1 the edge would then be at the talus
// angle. Edges take their turns in the order of the mesh until none is too high. The volume is then restored,
// which may make edges too high once more; slides and restoring take turns until none is.
//
// Before that, ground slides far: between clusters of vertices, and clusters of those
// (ground_slides_internal.h). The time therefore grows with the number of triangles. Large slopes end below
// the talus angle by up to 3 % of its tangent, alike in all directions.
//
// The surface stays a graph over the horizontal wherever it was one, and so it cannot run into itself.
// Vertices under overhangs and on walls are rock and stay where they are: one of their faces leans over or
// stands within 5 degrees of the vertical.
#pragma once

#include <cstdint>
#include <span>

#include "geometry/triangle_mesh.h"
#include "numerics/progress.h"

namespace astrolith {

struct ErosionStatistics {
  std::int64_t moved_vertices = 0;
  std::int64_t rock_vertices = 0;  // vertices that could not move
  int sweeps = 0;                  // over the vertices; those over clusters are not counted
  bool settled = false;            // whether steepest_after is at most the talus angle
  double steepest_before = 0.0;    // steepest edge between two vertices that are not rock, degrees
  double steepest_after = 0.0;     // the same edge of the finished mesh
  double volume_moved = 0.0;       // by which the surface fell where ground left, cubic length units
};

// Erodes a closed mesh in place. `up` holds a unit vector for each vertex, or zero for rock. The volume stays
// the same. Normals, where the mesh has them, become those of the new surface around vertices that moved. The
// talus angle is in degrees, in (0, 89]. The work is serial and follows the order of the mesh, so that the
// result depends on nothing else. Throws InputError for other angles, and WorkError when progress asks to
// stop.
ErosionStatistics erode(TriangleMesh& mesh, std::span<const Vec3d> up, double talus_degrees, int most_sweeps,
                        const Progress& progress = {});

}  // namespace astrolith
