// A batch: some layers of blocks that a GPU meshes together. The host works out what each block must know of
// the other blocks. Blocks are numbered layer by layer, and within a layer by y, then x.
#pragma once

#include <array>
#include <cstdint>
#include <limits>
#include <span>
#include <vector>

#include "synthesis/field/patch_place.h"
#include "synthesis/mesh/block_layer.h"
#include "synthesis/mesh/mesher.h"

namespace astrolith {

using MeshBlock = LayerBlock<kBlockCells>;

// The grid of a mesh and the frame that its coordinates belong to.
struct MeshGrid : BlockGrid<kBlockCells> {
  bool in_patch = false;  // whether the grid lies in the patch at `place`; else it lies in the body's frame
  PatchPlace place{{}};

  // A box of the body's frame that holds `size` x `size` blocks of layer z (BlockGrid::box).
  ASTROLITH_HD Box box_in_body(int x, int y, int z, int size) const {
    const Box blocks = box(x, y, z, size);
    return in_patch ? place.in_body(blocks) : blocks;
  }
};

// The grids of mesh_field and mesh_patch (synthesis/mesh/mesher.h), which say what they throw.
MeshGrid field_grid(const Box& bounds, int resolution, MeshTile tile = {});
MeshGrid patch_grid(const PatchPlace& place, double size, int resolution);

// The longest side of a block's box in the body's frame, for obstacle_on_gpu(), length units.
double block_side(const MeshGrid& grid);

// Why a batch could not be meshed. The backend's memory holds it as a number.
enum class MeshFailure : std::uint32_t { kNone, kBorder, kMissingBlock, kOpenSide };

// The place of a block in the grid and among the blocks of its batch.
struct BlockPlace {
  static constexpr std::int32_t kNone = std::numeric_limits<std::int32_t>::min();

  int x, y, z;  // place in the grid, in blocks
  // The owners of samples by owner_index() (synthesis/mesh/block_sampling.h). n >= 0 is block n of the batch.
  // -1 - n is block n of the layer below the batch, and kNone means that there is no such block.
  std::array<std::int32_t, 8> owner;
  std::uint32_t lacking;  // bit s is set where no active block lies beyond side s
  // Rows of samples of a layer are numbered by z, then y, then x. Their numbers follow from the number of the
  // first block of the layer, the number of its blocks, and both for this block's row of blocks.
  std::uint32_t layer_first, layer_blocks, row_first, row_blocks;

  // The number, among all rows of the batch, of the row of owned samples at local y, z of block number
  // `block`.
  ASTROLITH_HD std::uint32_t row(std::uint32_t block, int local_y, int local_z) const {
    constexpr std::uint32_t kRows = kBlockCells;
    const auto y_row = static_cast<std::uint32_t>(local_y - 1),
               z_row = static_cast<std::uint32_t>(local_z - 1);
    return kRows * kRows * layer_first + z_row * kRows * layer_blocks + kRows * (row_first - layer_first) +
           y_row * row_blocks + (block - row_first);
  }
};

// A block's place in its layer, in blocks.
struct BlockColumn {
  int x, y;
};

// The places of the blocks of consecutive layers that begin at `first_z`. `below` is the index of the layer
// before them, and has no size if there is none. Sides towards a layer that is not given count as not
// lacking. `last` becomes the index of the last layer.
std::vector<BlockPlace> place_blocks(const MeshGrid& grid, int first_z,
                                     std::span<const std::vector<BlockColumn>> layers,
                                     const LayerIndex& below, LayerIndex& last);

// Bit 5 of element i is set where block i of a layer has no active block above it. `columns` holds the blocks
// of the layer, `above` is the index of the layer above.
std::vector<std::uint32_t> lacking_above(std::span<const BlockColumn> columns, const LayerIndex& above);

}  // namespace astrolith
