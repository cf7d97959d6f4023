// The maps of a patch that synth writes: heights, and what is dangerous to a lander.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "geometry/triangle_mesh.h"
#include "tasks/job/job.h"
#include "tasks/synth/mesh_job.h"
#include "tasks/synth/surface_gravity.h"

namespace astrolith {

// The height maps of these names, each with its frame.
std::vector<std::filesystem::path> height_map_files(const std::vector<std::string>& names);

// Throws InputError for a map of a part that is no patch or faces no direction, whose recipe has no length
// unit, for a footprint that does not fit, and for a file that cannot be written.
void check_ground_maps(const MeshSinks& sinks, const MeshPart& part);

// Writes the maps of a patch's mesh, with as many pixels along a side as it has cells, and says in the
// summary what they show. The height map is a GeoTIFF of metres with its frame as JSON beside it ("patch.tif"
// and "patch.json"). The hazard map, for which gravity is known, is a GeoTIFF with the same pixels and three
// bands. Each says something of a footprint, the square of ground about a pixel that a lander stands on:
//   slope_deg    the angle between the vertical of gravity and rotation and the normal of the plane that fits
//                the ground best
//   roughness_m  the root mean square of the heights about that plane
//   boulder_m    the diameter of the largest boulder of the recipe's layers that reaches into the footprint
//                and is resolved, seen from above; 0 without one
// All are NaN where the footprint leaves the map or holds a pixel without height.
void write_ground_maps(Job& job, const MeshSinks& sinks, const MeshPart& part, const TriangleMesh& mesh,
                       const SurfaceGravity* gravity);

}  // namespace astrolith
