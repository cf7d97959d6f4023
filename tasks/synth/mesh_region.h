// The region of a mesh: the whole surface, a tile or a patch.
#pragma once

#include <filesystem>
#include <optional>
#include <string>

#include "geometry/surface/ground_plane.h"
#include "numerics/progress.h"
#include "synthesis/field/implicit_field.h"
#include "synthesis/mesh/even_mesh.h"
#include "synthesis/mesh/mesher.h"

namespace astrolith {

struct Region {
  MeshTile tile;
  bool is_patch = false;
  Vec3d center;                      // centre of a patch
  double size = 0.0;                 // side of a patch, length units
  bool aligned = false;              // whether the cube of a patch stands on its ground
  std::optional<GroundAxes> axes;    // of an aligned cube, where they are known: place_on_ground()
  std::optional<GroundPlane> plane;  // of its map, relative to `center`: place_on_ground()

  bool is_cut() const { return is_patch || tile.count > 1; }
  // A cube along the body's axes that holds the patch; none for the whole surface and for tiles.
  std::optional<PatchCube> cube() const {
    constexpr double kDiagonal = 1.7320508075688772;  // of a cube of side 1
    if (!is_patch) return std::nullopt;
    PatchCube cube{center, aligned ? kDiagonal * size : size};
    if (axes) cube.turned = {*axes, size};
    return cube;
  }
};

// A cube of this centre and side, in length units. Throws InputError for a side that is not above 0, and for
// numbers that are not finite or beyond kMaxNumber.
Region patch_region(const Vec3d& center, double side);

// The tile `number` of `count`, counted from 1. Throws InputError for a tile that does not exist.
Region tile_region(int number, int count);

// The point of the surface near the centre of a patch whose cube the surface misses, where there is one
// within a fiftieth of the body: as for a place on the mesh to which the recipe was fitted. None for other
// regions.
std::optional<Vec3d> surface_beside_patch(const ImplicitField& field, const Region& region);

// Finds the plane of a patch's map: the mean plane of the surface in its cube. A cube that is to be aligned
// turns to it; the plane then keeps the height of the centroid, and has the middle of the cube in its middle.
// The field is that of region.cube(). Nothing happens where the region is no patch or the cube holds no
// surface. Throws InputError for a cube to be aligned whose surface faces no direction.
void place_on_ground(const ImplicitField& field, Region& region);

// Names the part of a field or region that the GPU cannot mesh, in a few words. Empty where the GPU can mesh
// all. The field is that of region.cube() where the region is a patch.
std::string lacking_on_gpu(const ImplicitField& field, const Region& region, int resolution);

enum class MeshingDevice { kCpu, kGpu };

// Meshes the region; an aligned patch, too, has its vertices along the body's axes. Throws InputError for a
// patch whose cells are finer than the coordinates of a body made by operations, and what mesh_field throws.
MeshStatistics mesh_region(const ImplicitField& field, const Region& region, int resolution, MeshSink& sink,
                           const Progress& progress, MeshingDevice device = MeshingDevice::kCpu);

// Makes the triangles of the region's mesh, whose cells have this side, more even. Throws WorkError where
// progress asks to stop.
EvenStatistics even_region(const ImplicitField& field, const Region& region, double step, RecordedMesh& mesh,
                           const Progress& progress);

// A count in three characters or so: "1.2 M", "340 k".
std::string rounded_count(double count);

// Throws InputError for a region without surface at this resolution: the layer that takes the whole body
// away, where there is one, or what to ask for instead. `file` is the recipe's file.
[[noreturn]] void fail_empty(const Recipe& recipe, const ImplicitField& field, const Region& region,
                             int resolution, const std::filesystem::path& file);

}  // namespace astrolith
