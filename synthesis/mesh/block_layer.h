// One layer of sparse blocks along z: its samples, and the mesh vertices on their edges.
//
// A block of B^3 cells sees (B+1)^3 samples at local coordinates 0 .. B and owns the samples at 1 .. B. The
// other samples are its halo: they belong to its seven lower neighbours. An edge belongs to the owner of its
// upper end. A layer therefore needs the layer below it and no other.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <vector>

namespace astrolith {

// Bit x is set where the sample at local x of a row is inside.
using SignRow = std::uint32_t;

template <int B>
struct LayerBlock {
  static_assert(B + 1 <= 32, "a row of samples has its signs in one word");
  static constexpr int kSide = B + 1;
  static constexpr std::size_t kSamples = std::size_t{kSide} * kSide * kSide;
  static constexpr SignRow kWholeRow = (SignRow{2} << B) - 1;

  // The index of the sample at local coordinates 0 .. B.
  static constexpr std::size_t sample(int x, int y, int z) {
    return static_cast<std::size_t>((z * kSide + y) * kSide + x);
  }
  static constexpr std::size_t sign_row(int y, int z) { return static_cast<std::size_t>(z * kSide + y); }
  // The index of a row of owned samples: y and z are 1 .. B.
  static constexpr std::size_t row(int y, int z) { return static_cast<std::size_t>((z - 1) * B + y - 1); }

  // Both constructors leave the arrays uninitialised.
  LayerBlock() = default;
  LayerBlock(int block_x, int block_y) : x(block_x), y(block_y) {}

  int x = 0, y = 0;  // position in the layer, in blocks
  // The phases of the mesher fill in the arrays, in this order.
  std::array<float, kSamples> values;        // at every sample the block sees
  std::array<SignRow, kSide * kSide> signs;  // signs of the values
  // For each row of owned samples: first how many vertices and triangles it holds, later where they start in
  // the layer.
  std::array<std::uint32_t, B * B> vertex_rows;
  std::array<std::uint32_t, B * B> triangle_rows;
  // The number of the vertex on a crossed edge, indexed by (sample at the edge's upper end, axis).
  std::array<std::uint32_t, 3 * kSamples> vertices;
};

// The numbers of a layer's active blocks, by their places.
class LayerIndex {
 public:
  LayerIndex() = default;
  LayerIndex(int width, int height)
      : width_(width),
        height_(height),
        numbers_(static_cast<std::size_t>(width) * static_cast<std::size_t>(height), kAbsent) {}

  void set(int x, int y, std::int32_t number) { numbers_[slot(x, y)] = number; }
  void unset(int x, int y) { set(x, y, kAbsent); }
  bool contains(int x, int y) const { return x >= 0 && y >= 0 && x < width_ && y < height_; }
  bool has(int x, int y) const { return contains(x, y) && numbers_[slot(x, y)] != kAbsent; }
  // The number of the block at x, y, which must be active.
  std::int32_t at(int x, int y) const { return numbers_[slot(x, y)]; }

 private:
  static constexpr std::int32_t kAbsent = -1;
  std::size_t slot(int x, int y) const {
    return static_cast<std::size_t>(y) * static_cast<std::size_t>(width_) + static_cast<std::size_t>(x);
  }
  int width_ = 0, height_ = 0;
  std::vector<std::int32_t> numbers_;
};

template <int B>
class BlockLayer {
 public:
  BlockLayer() = default;
  BlockLayer(int width, int height) : index_(width, height) {}

  void add(int x, int y) {
    index_.set(x, y, static_cast<std::int32_t>(blocks.size()));
    blocks.emplace_back(x, y);
  }
  // Takes all blocks out again, but keeps their memory for the next ones.
  void clear() {
    for (const LayerBlock<B>& block : blocks) index_.unset(block.x, block.y);
    blocks.clear();
  }

  bool contains(int x, int y) const { return index_.contains(x, y); }
  // The active block at x, y; null where there is none.
  const LayerBlock<B>* find(int x, int y) const {
    return index_.has(x, y) ? &blocks[static_cast<std::size_t>(index_.at(x, y))] : nullptr;
  }

  std::vector<LayerBlock<B>> blocks;  // the active blocks, sorted by y and then x

 private:
  LayerIndex index_;
};

// The blocks that own the samples a block sees. In the index, bit 0 stands for one block lower in x, bit 1 in
// y, bit 2 in z. Entry 0 is the block itself; an entry is null where there is no active block.
template <int B>
using Owners = std::array<const LayerBlock<B>*, 8>;

template <int B>
Owners<B> find_owners(const BlockLayer<B>& layer, const BlockLayer<B>& below, const LayerBlock<B>& block) {
  Owners<B> owners;
  for (int i = 0; i < 8; ++i) {
    const BlockLayer<B>& where = (i & 4) != 0 ? below : layer;
    owners[static_cast<unsigned>(i)] = where.find(block.x - (i & 1), block.y - ((i >> 1) & 1));
  }
  owners[0] = &block;
  return owners;
}

// The index in Owners of the block that owns a local sample.
constexpr unsigned owner_index(int x, int y, int z) {
  return (x == 0 ? 1u : 0u) | (y == 0 ? 2u : 0u) | (z == 0 ? 4u : 0u);
}

}  // namespace astrolith
