// The maps of a patch that synth writes: heights, and what is dangerous to a lander.
#pragma once

#include <filesystem>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "geometry/surface/height_map.h"
#include "recipe/recipe.h"
#include "synthesis/field/implicit_field.h"
#include "tasks/job/job.h"
#include "tasks/synth/mesh_job.h"
#include "tasks/synth/mesh_region.h"
#include "tasks/synth/surface_gravity.h"

namespace astrolith {

// A patch whose plane is known.
struct PatchGround {
  const Recipe& recipe;
  const Region& region;
  const ImplicitField& field;
};

// The height maps of these names, each with its frame.
std::vector<std::filesystem::path> height_map_files(const std::vector<std::string>& names);

// Throws InputError, which names the option, when the region is no patch or faces no direction, the recipe
// has no length unit or a file cannot be written.
void check_map(const std::filesystem::path& file, const std::string& option, const Region& region,
               const Recipe& recipe, int resolution);
void check_height_map(const std::filesystem::path& file, const Region& region, const Recipe& recipe,
                      int resolution);
void check_hazard_map(const HazardRequest& request, const Region& region, const Recipe& recipe,
                      int resolution);

// The heights of the patch's mesh in metres, with `resolution` pixels along a side. The mesh is relative to
// the patch's centre.
HeightMap heights_of_patch(const TriangleMesh& mesh, const PatchGround& ground, int resolution);

// Where the pixels of a map lie in the body frame, and how many have no height.
nlohmann::ordered_json frame_json(const HeightMap& map, const PatchGround& ground);

// Writes the map as a GeoTIFF, and its frame as JSON beside it ("patch.tif" and "patch.json").
void write_height_map(Job& job, const std::filesystem::path& file, const HeightMap& map,
                      const PatchGround& ground);

// Writes a GeoTIFF with the pixels of the height map and three bands. Each says something of a footprint, the
// square of ground about a pixel that a lander stands on:
//   slope_deg    the angle between the vertical of gravity and rotation and the normal of the plane that fits
//                the ground best
//   roughness_m  the root mean square of the heights about that plane
//   boulder_m    the diameter of the largest boulder of the recipe's layers that reaches into the footprint
//                and is resolved, seen from above; 0 without one
// All are NaN where the footprint leaves the map or holds a pixel without height.
void write_hazard_map(Job& job, const HazardRequest& request, const HeightMap& map, const PatchGround& ground,
                      const SurfaceGravity& gravity);

}  // namespace astrolith
