// Finds the blocks of one layer that the surface may cross, by a quadtree over the layer. A square of blocks
// that a bound of the field proves to lie outside or inside the body is left out whole.
#pragma once

#include <algorithm>
#include <array>
#include <bit>
#include <vector>

#include "numerics/errors.h"
#include "numerics/parallel_for.h"
#include "synthesis/mesh/block_field.h"
#include "synthesis/mesh/block_layer.h"
#include "synthesis/mesh/sample_grid.h"

namespace astrolith {

// A square of blocks of one layer and the field narrowed to it.
template <FieldBlockLike Block>
struct BlockNode {
  int x = 0, y = 0;  // the block with the lowest x and y
  int size = 1;      // blocks along each side
  Block field;
};

// The part of a window that a block sees, in the block's local coordinates, as bits of rows along x.
template <int B>
struct BlockWindow {
  std::array<int, 3> first, last;

  // Bit x is set where the cell with upper corner x, y, z is meshed.
  ASTROLITH_HD SignRow cells(int y, int z) const {
    return within(y, first[1], last[1]) && within(z, first[2], last[2]) ? bits(first[0], last[0]) : 0;
  }
  // Bit x is set where the edge along axis that ends at x, y, z belongs to a meshed cell.
  ASTROLITH_HD SignRow edges(int y, int z, int axis) const {
    const auto start = [&](int a) { return first[static_cast<unsigned>(a)] - (a == axis ? 0 : 1); };
    return within(y, start(1), last[1]) && within(z, start(2), last[2]) ? bits(start(0), last[0]) : 0;
  }
  // Bit x is set for those of these edges that lie in a side of the window, where the mesh is open.
  ASTROLITH_HD SignRow cut_edges(int y, int z, int axis) const {
    const auto in_side = [&](int a, int c) {
      const auto i = static_cast<unsigned>(a);
      return a != axis && (c == first[i] - 1 || c == last[i]);
    };
    if (in_side(1, y) || in_side(2, z)) return edges(y, z, axis);
    const SignRow sides = bits(first[0] - 1, first[0] - 1) | bits(last[0], last[0]);
    return axis == 0 ? 0 : edges(y, z, axis) & sides;
  }

 private:
  ASTROLITH_HD static bool within(int c, int low, int high) { return c >= low && c <= high; }
  // Bits low .. high, as far as they are local coordinates.
  ASTROLITH_HD static SignRow bits(int low, int high) {
    low = std::max(low, 0);
    high = std::min(high, B);
    return low > high ? 0 : ((SignRow{2} << high) - 1) & ~((SignRow{1} << low) - 1);
  }
};

// Splits a grid into blocks of B^3 cells, and layers of such blocks along z.
template <int B>
struct BlockGrid {
  SampleGrid samples;
  CellWindow window;
  bool closed;  // the surface must not touch the border of the grid

  ASTROLITH_HD int blocks(unsigned axis) const { return (samples.cells[axis] + B - 1) / B; }
  // The window in the local coordinates of block x, y, z.
  ASTROLITH_HD BlockWindow<B> block_window(int x, int y, int z) const {
    BlockWindow<B> local;
    const std::array<int, 3> block{x, y, z};
    for (std::size_t axis = 0; axis < 3; ++axis) {
      local.first[axis] = window.first[axis] - block[axis] * B;
      local.last[axis] = window.last[axis] - block[axis] * B;
    }
    return local;
  }
  // The box of `size` x `size` blocks of layer z from block x, y on. It is half a step wider than their
  // samples, so that normals can be taken at its border.
  ASTROLITH_HD Box box(int x, int y, int z, int size) const {
    const auto last = [&](unsigned axis, int block) { return std::min(block * B, samples.cells[axis]); };
    return samples.box({x * B, y * B, z * B}, {last(0, x + size), last(1, y + size), last(2, z + 1)},
                       0.5 * samples.step);
  }
};

[[noreturn]] inline void fail_at_border() {
  throw WorkError("mesher: the body reaches the border of its bounds; the field's bounds are wrong");
}

template <int B, FieldBlockLike Block>
void check_inside_node(const BlockGrid<B>& grid, int z, const BlockNode<Block>& node) {
  const bool at_border = node.x == 0 || node.y == 0 || z == 0 || node.x + node.size >= grid.blocks(0) ||
                         node.y + node.size >= grid.blocks(1) || z + 1 == grid.blocks(2);
  if (at_border) fail_at_border();
}

// The quarters of a node that are not proved to lie outside or inside the body.
template <int B, FieldBlockLike Block>
std::vector<BlockNode<Block>> mixed_quarters(const BlockGrid<B>& grid, int z, const BlockNode<Block>& node) {
  std::vector<BlockNode<Block>> quarters;
  const int half = node.size / 2;
  for (int y = node.y; y < std::min(node.y + node.size, grid.blocks(1)); y += half) {
    for (int x = node.x; x < std::min(node.x + node.size, grid.blocks(0)); x += half) {
      BlockNode<Block> quarter{x, y, half, node.field.restricted_to(grid.box(x, y, z, half))};
      const BlockContent content = quarter.field.content();
      if (content == BlockContent::kInside && grid.closed) check_inside_node(grid, z, quarter);
      if (content == BlockContent::kMixed) quarters.push_back(std::move(quarter));
    }
  }
  return quarters;
}

// The blocks of layer z that the surface may cross, sorted by y and then x. Throws WorkError when the body
// fills a block at the border of the grid.
template <int B, FieldBlockLike Block>
std::vector<BlockNode<Block>> mixed_blocks(const BlockGrid<B>& grid, const Block& whole, int z) {
  const unsigned longest = static_cast<unsigned>(std::max(grid.blocks(0), grid.blocks(1)));
  const int size = std::max(2, static_cast<int>(std::bit_ceil(longest)));
  std::vector<BlockNode<Block>> nodes;
  nodes.push_back({0, 0, size, whole.restricted_to(grid.box(0, 0, z, size))});
  while (!nodes.empty() && nodes.front().size > 1) {
    std::vector<std::vector<BlockNode<Block>>> quarters(nodes.size());
    parallel_for(0, static_cast<std::int64_t>(nodes.size()), [&](std::int64_t i) {
      const auto n = static_cast<std::size_t>(i);
      quarters[n] = mixed_quarters(grid, z, nodes[n]);
    });
    nodes.clear();
    for (auto& group : quarters) {
      for (auto& quarter : group) nodes.push_back(std::move(quarter));
    }
  }
  std::sort(nodes.begin(), nodes.end(),
            [](const auto& a, const auto& b) { return a.y != b.y ? a.y < b.y : a.x < b.x; });
  return nodes;
}

}  // namespace astrolith
