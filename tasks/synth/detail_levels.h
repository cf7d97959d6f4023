// Levels of detail: meshes of one recipe, each of a quarter of the triangles of the one before.
#pragma once

#include <filesystem>
#include <span>
#include <string>
#include <vector>

#include "geometry/io/mesh_io.h"
#include "geometry/surface/surface_distance.h"
#include "geometry/triangle_mesh.h"
#include "tasks/job/job.h"
#include "tasks/synth/body_mesh.h"

namespace astrolith {

struct DetailLevel {
  TriangleMesh mesh;
  int resolution = 0;
  SurfaceDistanceReport error;  // from the finest mesh, length units
};

// The file of level `level`: rock.ply, rock_lod1.ply, rock_lod2.ply; of a .glb, the one that holds all.
std::filesystem::path level_file(const std::filesystem::path& output, int level);
std::vector<std::filesystem::path> level_files(const std::filesystem::path& output, int levels);

// Throws InputError where the coarsest of so many levels would have fewer cells than a mesh needs.
void check_levels(int levels, int resolution);

// Makes levels 1 .. levels - 1 of the part's mesh: each has half of the cells along a side of the level
// before. Throws what make_body_mesh() and surface_distance() throw.
std::vector<DetailLevel> coarser_levels(Job& job, const MeshPart& part, int levels, const TriangleMesh& mesh);

// Writes the coarser levels beside the mesh, or all levels into one .glb, and reports them. `levels` has the
// meshes of all, the finest first, with what lies on them; the finest has `resolution` cells.
void write_levels(Job& job, const std::filesystem::path& output, int resolution,
                  const std::vector<DetailLevel>& coarser, std::span<const MeshLevel> levels,
                  const MeshFileInfo& info);

}  // namespace astrolith
