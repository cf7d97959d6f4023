// Texture coordinates by charts, and the maps that are baked for them.
#pragma once

#include <filesystem>
#include <vector>

#include "geometry/io/mesh_io.h"
#include "recipe/recipe.h"
#include "synthesis/field/surface_colors.h"
#include "tasks/job/job.h"
#include "tasks/synth/body_mesh.h"
#include "tasks/synth/mesh_job.h"

namespace astrolith {

void declare_bake_options(Job& job, MeshRequest& request);

// Throws InputError for maps without charts, of a part of a body, or of a recipe with erosion, which moves
// the mesh away from its field.
void check_bake(const MeshRequest& request, const Recipe& recipe, const std::filesystem::path& file,
                bool is_cut);

// The maps that may be written beside the mesh: rock_normal.png, rock_lod1_normal.png, ...
std::vector<std::filesystem::path> map_files(const MeshRequest& request, const std::filesystem::path& output);

// What the maps of a mesh are made from.
struct SkinSources {
  const BodyMeshJob& made_by;   // the finest mesh
  const SurfaceColors* colors;  // null: no layer paints
  const std::filesystem::path& output;
};

// Gives each level, the finest first, its atlas, and with --bake its maps, which are also written as files.
// Maps of a level have half of the side of those of the level before. Reports the atlases as "charts" and the
// maps as "maps" in the summary.
void add_skins(Job& job, const MeshRequest& request, const SkinSources& sources,
               std::vector<MeshLevel>& levels);

}  // namespace astrolith
