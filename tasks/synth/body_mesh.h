// The mesh of a recipe's body: whole, a tile or a patch, checked to be a closed manifold.
#pragma once

#include <cstdint>
#include <filesystem>
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "geometry/surface/ground_plane.h"
#include "numerics/progress.h"
#include "recipe/recipe.h"
#include "synthesis/field/implicit_field.h"
#include "synthesis/finish/erosion.h"
#include "synthesis/mesh/even_mesh.h"
#include "synthesis/mesh/manifold_check.h"
#include "synthesis/mesh/mesher.h"

namespace astrolith {

// What a mesh is to be. The command line, its members and Python fill in the same struct (mesh_options.cpp).
struct MeshSpec {
  // What of the body it shows: a tile, a patch, or the whole.
  std::string tile = {};           // "3/16"; empty = the whole
  std::vector<double> patch = {};  // centre and side; empty = the whole
  bool aligned = false;            // the cube of the patch stands on its ground
  double least_component = 0.0;    // share of the largest piece's volume that a piece needs; 0 = all stay

  // How fine it is.
  int resolution = 256;    // cells along the longest side of the body, or of the patch
  double triangles = 0.0;  // choose the resolution; 0 = as stated
  bool even = false;       // triangles are made more even, for which the mesh is kept in memory

  // What its vertices carry.
  bool points = false;  // the mesh has vertices alone
  bool labels = false;
  std::vector<double> gravity = {};  // density in kg/m3 and period in hours, 0 hours = at rest; empty = none
  std::string uv = {};               // texture coordinates: "longitude" or "charts"; empty = none

  bool has_charts() const { return uv == "charts"; }
};

struct Region {
  MeshTile tile;
  bool is_patch = false;
  Vec3d center;                      // centre of a patch
  double size = 0.0;                 // side of a patch, length units
  bool aligned = false;              // whether the cube of a patch stands on its ground
  std::optional<GroundAxes> axes;    // of an aligned cube, where they are known
  std::optional<GroundPlane> plane;  // of a patch's map, relative to `center`, where it is known

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

// The region of a mesh; the centre of a patch is in the frame of the recipe's file. Throws InputError for a
// tile that does not exist, a side that is not above 0, and numbers that are not finite or beyond kMaxNumber.
Region make_region(const MeshSpec& spec);

enum class MeshingDevice { kCpu, kGpu };

// The part of a recipe's body that is meshed: its field in a region, and the cells of the mesh.
struct MeshPart {
  const MeshSpec& spec;
  const Recipe& recipe;
  const std::filesystem::path& file;  // the recipe's, for messages
  Region region;
  ImplicitField field;  // of the recipe in region.cube()
  int resolution;       // cells along the longest side of the body, or of the patch
  MeshingDevice device = MeshingDevice::kCpu;
  bool may_be_empty = false;  // a tile need not hold any of the surface

  // Returns this part with other cells; it is meshed on the CPU where the GPU lacks what they take.
  MeshPart with_cells(int cells) const;
};

// Throws InputError for a recipe of layers alone. `file` is the recipe's.
void require_body(const Recipe& recipe, const std::filesystem::path& file);

// The field of a recipe's body in a region. Throws InputError for a body that no point of space reaches, and
// what ImplicitField throws; `like` is as there.
ImplicitField make_region_field(const Recipe& recipe, const std::filesystem::path& file, const Region& region,
                                const Progress& progress = {}, const ImplicitField* like = nullptr);

// The part of the body that a spec names, with the spec's resolution. A patch whose cube the surface misses,
// if there is surface within a fiftieth of the body, is moved onto it, of which `say` gets a line: so a place
// on the mesh to which a recipe was fitted will do.
//
// An aligned cube turns to its ground. Where `needs_plane`, the plane of the patch's map is found, too; where
// the surface misses the cube or faces no direction there is none. The ground is the recipe without what is
// added to it, so that maps of a patch with and without additions share their pixels: where there is a
// relief, the body and the relief without its finer levels and its fills; elsewhere all but landforms drawn
// by cells, Gabor layers and exemplars, unless a mask asks for them. Throws InputError as make_region() and
// make_region_field() do, and for an aligned cube whose surface faces no direction.
MeshPart make_body_part(const MeshSpec& spec, const Recipe& recipe, const std::filesystem::path& file,
                        bool needs_plane, const Progress& progress,
                        const std::function<void(const std::string&)>& say);

// Names what the GPU cannot mesh of a part, in a few words. Empty where the GPU can mesh all.
std::string lacking_on_gpu(const MeshPart& part);

// Meshes the part without a check; an aligned patch, too, has its vertices along the body's axes. Throws
// InputError for a patch whose cells are finer than the coordinates of a body made by operations, and what
// mesh_field throws.
MeshStatistics mesh_part(const MeshPart& part, MeshSink& sink, const Progress& progress);

struct BodyMeshReport {
  MeshStatistics statistics;
  ManifoldReport manifold;
  std::int64_t dropped_components = 0;  // pieces and cavities that were too small
  std::optional<EvenStatistics> even;   // where triangles were made more even
};

// Passes the mesh on to the sink. The mesh is made twice where small pieces are left out; the stages are then
// "pieces" and "mesh", else "mesh" alone, and "even" may follow. Throws InputError for a part without
// surface, unless it may be empty, with the layer that takes the whole body away, or what to ask for
// instead. Throws WorkError for a mesh that is not manifold, or open elsewhere than where it was cut; the
// sink has been filled by then.
BodyMeshReport make_body_mesh(const MeshPart& part, MeshSink& sink, const StageProgress& progress);

// Erodes a whole body as a recipe says, against the gravity of its mesh, which must be closed. Throws what
// erode() throws, and InputError for a mesh without a facet that has an area.
ErosionStatistics erode_body(const Erosion& erosion, TriangleMesh& mesh, const Progress& progress);

}  // namespace astrolith
