// Some layers of blocks that a GPU meshes together: what each block must know of the others, worked out on
// the host. Blocks are numbered layer by layer, and in a layer in rows of y, then x.
#pragma once

#include <array>
#include <cstdint>
#include <limits>
#include <span>
#include <vector>

#include "synthesis/mesh/mesher.h"

namespace astrolith {

using MeshBlock = LayerBlock<kBlockCells>;
using MeshGrid = BlockGrid<kBlockCells>;

// Why a batch could not be meshed; as a number in the backend's memory.
enum class MeshFailure : std::uint32_t { kNone, kBorder, kMissingBlock, kOpenSide };

struct BlockPlace {
  static constexpr std::int32_t kNone = std::numeric_limits<std::int32_t>::min();

  int x, y, z;  // in the grid, in blocks
  // By owner_of(): its number in the batch, or -1 less its number in the layer below the batch, or kNone.
  std::array<std::int32_t, 8> owner;
  std::uint32_t lacking;  // bit s is set where a side s has no active block beyond it
  // Rows of a layer are numbered by z, then y, then x: where those of the block's layer begin, how many
  // blocks that has, and which and how many of them lie in this block's row of blocks.
  std::uint32_t first_of_layer, blocks_of_layer, first_of_row, blocks_of_row;

  // Of the owned samples at local y, z of block number `block`, among all rows of the batch.
  ASTROLITH_HD std::uint32_t row(std::uint32_t block, int local_y, int local_z) const {
    constexpr std::uint32_t kRows = kBlockCells;
    const auto y_row = static_cast<std::uint32_t>(local_y - 1),
               z_row = static_cast<std::uint32_t>(local_z - 1);
    return kRows * kRows * first_of_layer + z_row * kRows * blocks_of_layer +
           kRows * (first_of_row - first_of_layer) + y_row * blocks_of_row + (block - first_of_row);
  }
};

// Which block of a layer stands where.
class LayerIndex {
 public:
  LayerIndex() = default;
  LayerIndex(int width, int height)
      : width_(width), height_(height), numbers_(static_cast<std::size_t>(width) * height, kAbsent) {}

  void set(int x, int y, std::int32_t number) { numbers_[slot(x, y)] = number; }
  bool contains(int x, int y) const { return x >= 0 && y >= 0 && x < width_ && y < height_; }
  bool has(int x, int y) const { return contains(x, y) && numbers_[slot(x, y)] != kAbsent; }
  // Number of an active block.
  std::int32_t at(int x, int y) const { return numbers_[slot(x, y)]; }

 private:
  static constexpr std::int32_t kAbsent = -1;
  std::size_t slot(int x, int y) const {
    return static_cast<std::size_t>(y) * static_cast<std::size_t>(width_) + static_cast<std::size_t>(x);
  }
  int width_ = 0, height_ = 0;
  std::vector<std::int32_t> numbers_;
};

// A block's place in its layer, in blocks.
struct BlockColumn {
  int x, y;
};

// Places of the blocks of consecutive layers that begin at `first_z`; `below` is of the layer before them (no
// size: there is none). Sides towards a layer that is not given count as not lacking. Fills `last`, of the
// last layer.
std::vector<BlockPlace> place_blocks(const MeshGrid& grid, int first_z,
                                     std::span<const std::vector<BlockColumn>> layers,
                                     const LayerIndex& below, LayerIndex& last);

// Of the blocks of the layer that `columns` holds: which of them have no active block above, by the index of
// that layer.
std::vector<std::uint32_t> lacking_above(std::span<const BlockColumn> columns, const LayerIndex& above);

}  // namespace astrolith
