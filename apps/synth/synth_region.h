// The region that synth meshes: the whole surface, a tile or a patch.
#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "numerics/progress.h"
#include "synthesis/field/implicit_field.h"
#include "synthesis/mesh/mesher.h"

namespace astrolith {

struct Region {
  MeshTile tile;
  bool is_patch = false;
  Vec3d center;       // centre of a patch
  double size = 0.0;  // side of a patch, length units

  bool is_cut() const { return is_patch || tile.count > 1; }
  // The cube of a patch; none for the whole surface and for tiles.
  std::optional<PatchCube> cube() const {
    return is_patch ? std::optional(PatchCube{center, size}) : std::nullopt;
  }
};

// Reads a tile such as "3/16", the third of sixteen, or a patch's centre and side. Empty arguments stand for
// the whole surface. Throws InputError for anything else.
Region parse_region(const std::string& tile, const std::vector<double>& patch);

// Names the part of a field or region that the GPU cannot mesh, in a few words. Empty where the GPU can mesh
// all.
std::string lacking_on_gpu(const ImplicitField& field, const Region& region, int resolution);

enum class MeshingDevice { kCpu, kGpu };
MeshStatistics mesh_region(const ImplicitField& field, const Region& region, int resolution, MeshSink& sink,
                           const Progress& progress, MeshingDevice device = MeshingDevice::kCpu);

// Throws InputError for a region without surface at this resolution: the layer that takes the whole body
// away, where there is one, or what to ask for instead. `file` is the recipe's file.
[[noreturn]] void fail_empty(const Recipe& recipe, const ImplicitField& field, const Region& region,
                             int resolution, const std::filesystem::path& file);

}  // namespace astrolith
