// Sorts the vertices of a mesh into blocks of space, so that a field can be narrowed to a block and evaluated
// at all its vertices together.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "numerics/vec3.h"

namespace astrolith {

// The vertices of a block: numbers[begin] .. numbers[end - 1].
struct VertexBlock {
  std::size_t slab;
  std::size_t begin, end;
};

// Blocks are cubes, and all blocks between two heights make up a slab. Empty blocks are left out.
struct VertexBlocks {
  std::vector<std::uint32_t> numbers;
  std::vector<VertexBlock> blocks;  // by slab
  std::vector<std::size_t> slabs;   // slab s is numbers[slabs[s]] .. numbers[slabs[s + 1] - 1]

  std::span<const std::uint32_t> numbers_of(std::size_t begin, std::size_t end) const {
    return std::span(numbers).subspan(begin, end - begin);
  }
  std::size_t num_slabs() const { return slabs.empty() ? 0 : slabs.size() - 1; }
};

// Sorts the vertices of these numbers into blocks of this side, length units. Vertices of a block keep their
// order.
VertexBlocks sort_into_blocks(std::span<const Vec3f> places, std::vector<std::uint32_t> numbers, double side);

// The least box that holds the places of these numbers.
Box box_around(std::span<const Vec3f> places, std::span<const std::uint32_t> numbers);

}  // namespace astrolith
