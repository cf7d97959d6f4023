// Texture coordinates by charts, and the maps that are baked for them.
#pragma once

#include <filesystem>
#include <vector>

#include "geometry/io/mesh_io.h"
#include "synthesis/field/surface_colors.h"
#include "tasks/job/job.h"
#include "tasks/synth/mesh_job.h"

namespace astrolith {

inline constexpr int kLeastMap = 64, kMostMap = 16384;  // sides of baked maps, texels

// The maps that may be written beside a mesh: rock_normal.png, rock_lod1_normal.png, ...
std::vector<std::filesystem::path> map_files(const std::filesystem::path& mesh, const MeshSinks& sinks);

// Gives each level of the part's mesh, the finest first, its atlas, and with --bake its maps, which are also
// written as files. Without `colors` no layer paints. Maps of a level have half of the side of those of the
// level before. Reports the atlases as "charts" and the maps as "maps" in the summary.
void add_skins(Job& job, const MeshSinks& sinks, const MeshPart& part, const SurfaceColors* colors,
               std::vector<MeshLevel>& levels);

}  // namespace astrolith
