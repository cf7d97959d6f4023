// The steps in which a backend finds the blocks that the surface may cross, by quadtrees over layers of
// blocks: mixed_blocks (synthesis/mesh/block_culling.h) for many nodes at once, with the bounds of
// synthesis/field/flat_bounds.h. A node carries lists of what of the field reaches it, chosen from its
// parent's.
#pragma once

#include "cuda/backend_lists.h"
#include "cuda/mesher/mesh_batch.h"
#include "synthesis/field/flat_bounds.h"

namespace astrolith {

// A square of blocks of layer z; no size: there is none.
struct CullNode {
  int x, y, z, size;
};

// Lists of a node, in this order: metaballs of each leaf, craters of each layer of such, boulders. Where
// Gabor noise is, metaballs of each leaf again, now those that reach its cells around the block.
struct NodeLists {
  std::uint32_t leaves, landforms, wide;

  ASTROLITH_HD std::uint32_t count() const { return leaves + landforms + wide; }
};

// Nodes in a backend's memory, and their lists.
struct CullNodes {
  const CullNode* nodes;
  const FlatRange* ranges;  // (nodes, lists)
  const std::uint32_t* numbers;
};

// A thread a quarter of a node.
struct MakeQuarters {
  MeshGrid grid;
  const CullNode* parents;
  CullNode* quarters;

  ASTROLITH_HD void operator()(std::size_t i) const {
    const CullNode parent = parents[i / 4];
    const int half = parent.size / 2, x = parent.x + (i % 4 % 2 == 1 ? half : 0),
              y = parent.y + (i % 4 >= 2 ? half : 0);
    const bool exists = x < grid.blocks(0) && y < grid.blocks(1);
    quarters[i] = {x, y, parent.z, exists ? half : 0};
  }
};

// Writes the numbers in list i % lists of node i / lists, from those in its parent's.
struct NarrowLists {
  FlatField field;
  MeshGrid grid;
  NodeLists lists;
  double wide_margin;
  const CullNode* nodes;
  CullNodes parents;
  std::uint32_t nodes_a_parent;

  ASTROLITH_HD Box box_of(const CullNode& node, std::uint32_t list) const {
    const Box box = grid.box(node.x, node.y, node.z, node.size);
    if (list < lists.leaves) return flat_leaf_box(field, list, box);
    if (list == lists.leaves + field.boulder_list) return box;
    if (list < lists.leaves + lists.landforms) {
      return farthest_projected_box(flat_body_box(field, box), field.height_bound);
    }
    const Box at = farthest_projected_box(flat_body_box(field, box), field.height_bound);
    return field.num_steps == 0
               ? widened(at, wide_margin)
               : flat_leaf_box(field, list - lists.leaves - lists.landforms, widened(at, wide_margin));
  }
  ASTROLITH_HD bool reaches(std::uint32_t list, std::uint32_t number, const Box& box) const {
    if (list < lists.leaves) return metaball_reaches(field, list, number, box);
    if (list == lists.leaves + field.boulder_list) return boulder_reaches(field, number, box);
    if (list < lists.leaves + lists.landforms) {
      const FlatLayer& layer = field.layers[field.crater_layers[list - lists.leaves]];
      return boxes_touch(crater_reach(field.craters[layer.parts.first + number]), box);
    }
    return metaball_reaches(field, list - lists.leaves - lists.landforms, number, box);
  }
  template <typename Writer>
  ASTROLITH_HD void operator()(std::size_t i, Writer& write) const {
    const std::size_t n = i / lists.count();
    const auto list = static_cast<std::uint32_t>(i % lists.count());
    if (nodes[n].size == 0) return;
    const Box box = box_of(nodes[n], list);
    const FlatRange of_parent = parents.ranges[n / nodes_a_parent * lists.count() + list];
    for (std::uint32_t k = of_parent.first; k < of_parent.first + of_parent.count; ++k) {
      if (reaches(list, parents.numbers[k], box)) write(parents.numbers[k]);
    }
  }
};

// A thread a list: where it is, from where it begins and the next one does.
struct MakeRanges {
  const std::uint32_t* first;
  FlatRange* ranges;
  ASTROLITH_HD void operator()(std::size_t i) const { ranges[i] = {first[i], first[i + 1] - first[i]}; }
};

// A thread a node: 1 where the surface may cross it.
struct FlagMixed {
  FlatField field;
  MeshGrid grid;
  NodeLists lists;
  CullNodes nodes;
  KernelInterval* scratch;  // as many as there are numbers
  std::uint32_t* flags;
  std::uint32_t* failure;  // a MeshFailure

  ASTROLITH_HD void operator()(std::size_t i) const {
    const CullNode node = nodes.nodes[i];
    flags[i] = 0;
    if (node.size == 0) return;
    const FlatNear near{nodes.numbers, nodes.ranges + i * lists.count()};
    const BlockContent content = flat_content(field, near, grid.box(node.x, node.y, node.z, node.size),
                                              scratch + near.ranges[0].first);
    if (content == BlockContent::kInside && grid.closed && is_at_border(node)) {
      *failure = static_cast<std::uint32_t>(MeshFailure::kBorder);
    }
    flags[i] = content == BlockContent::kMixed ? 1 : 0;
  }

 private:
  ASTROLITH_HD bool is_at_border(const CullNode& n) const {
    return n.x == 0 || n.y == 0 || n.z == 0 || n.x + n.size >= grid.blocks(0) ||
           n.y + n.size >= grid.blocks(1) || n.z + 1 == grid.blocks(2);
  }
};

// A thread a node: those that are kept, in their order.
struct KeepMixed {
  std::uint32_t lists;
  CullNodes from;
  const std::uint32_t* place;  // running sum of the flags, one more than there are nodes
  CullNode* nodes;
  FlatRange* ranges;

  ASTROLITH_HD void operator()(std::size_t i) const {
    const std::uint32_t to = place[i];
    if (place[i + 1] == to) return;
    nodes[to] = from.nodes[i];
    for (std::uint32_t l = 0; l < lists; ++l) ranges[to * lists + l] = from.ranges[i * lists + l];
  }
};

// A thread a block: marks its place among all of some layers, from `first_z` on, in rows of y, then x.
struct MarkBlocks {
  MeshGrid grid;
  int first_z;
  const CullNode* nodes;
  std::uint32_t* marks;

  ASTROLITH_HD std::size_t slot(const CullNode& n) const {
    const auto width = static_cast<std::size_t>(grid.blocks(0)),
               height = static_cast<std::size_t>(grid.blocks(1));
    return (static_cast<std::size_t>(n.z - first_z) * height + static_cast<std::size_t>(n.y)) * width +
           static_cast<std::size_t>(n.x);
  }
  ASTROLITH_HD void operator()(std::size_t i) const { marks[slot(nodes[i])] = 1; }
};
// And the same order for the blocks and their lists, from the running sum of the marks.
struct OrderBlocks {
  MarkBlocks places;
  std::uint32_t lists;
  const FlatRange* from_ranges;
  CullNode* nodes;
  FlatRange* ranges;

  ASTROLITH_HD void operator()(std::size_t i) const {
    const CullNode node = places.nodes[i];
    const std::uint32_t to = places.marks[places.slot(node)];
    nodes[to] = node;
    for (std::uint32_t l = 0; l < lists; ++l) ranges[to * lists + l] = from_ranges[i * lists + l];
  }
};

}  // namespace astrolith
