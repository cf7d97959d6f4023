// Steps that write the lists of blocks (synthesis/field/field_tables.h) on a backend: each struct writes list
// number i, by the rule of synthesis/field/gathering.h.
#pragma once

#include "cuda/mesher/cull_steps.h"

namespace astrolith {

// Blocks, and the lists that culling left of them.
struct GatherFrom {
  FieldView field;
  MeshGrid grid;
  NodeLists lists;
  CullNodes blocks;

  ASTROLITH_HD Box box(std::size_t block) const {
    const CullNode& n = blocks.nodes[block];
    return grid.box(n.x, n.y, n.z, 1);
  }
  ASTROLITH_HD ListRange range(std::size_t block, std::size_t list) const {
    return blocks.ranges[block * lists.count() + list];
  }
};

// The metaballs of leaf i % leaves and block i / leaves, from list `first_list` on.
struct GatherMetaballs {
  GatherFrom from;
  std::uint32_t first_list;

  template <typename Writer>
  ASTROLITH_HD void operator()(std::size_t i, Writer& write) const {
    const std::size_t leaf = i % from.lists.leaves;
    const ListRange range = from.range(i / from.lists.leaves, first_list + leaf);
    const MetaballSphere<float>* spheres =
        from.field.arrays[from.field.leaf(static_cast<std::uint32_t>(leaf)).spheres];
    for (std::uint32_t k = range.first; k < range.first + range.count; ++k) {
      write(spheres[from.blocks.numbers[k]]);
    }
  }
};

// The numbers of craters and boulders.
struct GatherLandforms {
  GatherFrom from;

  template <typename Writer>
  ASTROLITH_HD void operator()(std::size_t i, Writer& write) const {
    const ListRange range =
        from.range(i / from.lists.landforms, from.lists.leaves + i % from.lists.landforms);
    for (std::uint32_t k = range.first; k < range.first + range.count; ++k) write(from.blocks.numbers[k]);
  }
};

struct GatherSpots {
  GatherFrom from;

  template <typename Writer>
  ASTROLITH_HD void operator()(std::size_t i, Writer& write) const {
    const std::uint32_t lists = from.field.spot_lists.count;
    gather_spots(from.field, static_cast<std::uint32_t>(i % lists), from.box(i / lists), write);
  }
};

struct GatherGabor {
  GatherFrom from;
  LeafLists metaballs;  // of all blocks, around their cells of impulses

  template <typename Writer>
  ASTROLITH_HD void operator()(std::size_t i, Writer& write) const {
    const std::uint32_t lists = from.field.gabor_lists.count;
    const LeafLists of_block{metaballs.spheres, metaballs.first + i / lists * from.lists.leaves};
    gather_gabor(from.field, static_cast<std::uint32_t>(i % lists), of_block, from.box(i / lists), write);
  }
};

}  // namespace astrolith
