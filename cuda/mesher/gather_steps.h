// The steps that write the lists of blocks (synthesis/field/field_tables.h) on a backend. Each struct writes
// the items of list number i, by the rules of synthesis/field/gathering.h.
#pragma once

#include "cuda/mesher/cull_steps.h"

namespace astrolith {

// The blocks that were culled, and their lists.
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

// Writes the metaballs of leaf i % leaves that reach block i / leaves. `first_list` is 0, or the number of
// the first wide list (NodeLists).
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

// Writes the numbers of craters or boulders in landform list i % landforms of block i / landforms.
struct GatherLandforms {
  GatherFrom from;

  template <typename Writer>
  ASTROLITH_HD void operator()(std::size_t i, Writer& write) const {
    const ListRange range =
        from.range(i / from.lists.landforms, from.lists.leaves + i % from.lists.landforms);
    for (std::uint32_t k = range.first; k < range.first + range.count; ++k) write(from.blocks.numbers[k]);
  }
};

// Writes the spots of spot list i % lists that reach block i / lists.
struct GatherSpots {
  GatherFrom from;

  template <typename Writer>
  ASTROLITH_HD void operator()(std::size_t i, Writer& write) const {
    const std::uint32_t lists = from.field.spot_lists.count;
    gather_spots(from.field, static_cast<std::uint32_t>(i % lists), from.box(i / lists), write);
  }
};

// Writes the impulses of Gabor list i % lists that may reach block i / lists.
struct GatherGabor {
  GatherFrom from;
  LeafLists metaballs;  // the wide lists of all blocks

  template <typename Writer>
  ASTROLITH_HD void operator()(std::size_t i, Writer& write) const {
    const std::uint32_t lists = from.field.gabor_lists.count;
    const LeafLists of_block{metaballs.spheres, metaballs.first + i / lists * from.lists.leaves};
    gather_gabor(from.field, static_cast<std::uint32_t>(i % lists), of_block, from.box(i / lists), write);
  }
};

}  // namespace astrolith
