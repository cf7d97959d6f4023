// What synth meshes: the whole surface, a tile or a patch of it.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "numerics/progress.h"
#include "synthesis/field/implicit_field.h"
#include "synthesis/mesh/mesher.h"

namespace astrolith {

struct Region {
  MeshTile tile;
  bool is_patch = false;
  Vec3d center;       // of a patch
  double size = 0.0;  // its side, length units

  bool is_cut() const { return is_patch || tile.count > 1; }
};

// From "3/16", the third of sixteen tiles, or from a patch's centre and side; empty = the whole. Throws
// InputError for others.
Region parse_region(const std::string& tile, const std::vector<double>& patch);

// What of a field, or of a region, the GPU cannot mesh, in a few words; empty: nothing.
std::string lacking_on_gpu(const ImplicitField& field, const Region& region, int resolution);

enum class MeshingDevice { kCpu, kGpu };
MeshStatistics mesh_region(const ImplicitField& field, const Region& region, int resolution, MeshSink& sink,
                           const Progress& progress, MeshingDevice device = MeshingDevice::kCpu);

// The error of a region without surface; `file` is the recipe's.
[[noreturn]] void fail_empty(const ImplicitField& field, const Region& region,
                             const std::filesystem::path& file);

}  // namespace astrolith
