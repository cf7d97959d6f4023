// The height map of synth's patch.
#pragma once

#include <filesystem>

#include "apps/program.h"
#include "geometry/triangle_mesh.h"
#include "recipe/recipe.h"
#include "tasks/synthesis/mesh_region.h"

namespace astrolith {

// The height maps of these names, and their frames.
std::vector<std::filesystem::path> height_map_files(const std::vector<std::string>& names);

// Throws InputError when the region is no patch, the recipe has no length unit or a file cannot be written.
void check_height_map(const std::filesystem::path& file, const Region& region, const Recipe& recipe,
                      int resolution);

// Writes the patch as a GeoTIFF of metres over its mean plane, and its frame as JSON beside it ("patch.tif"
// and "patch.json"). The mesh is relative to the patch's centre. The map has `resolution` pixels along a
// side.
void write_height_map(Program& program, const std::filesystem::path& file, const TriangleMesh& mesh,
                      const Region& region, const Recipe& recipe, int resolution);

}  // namespace astrolith
