// The steps in which a backend finds the blocks that the surface may cross. They do the work of mixed_blocks
// (synthesis/mesh/block_culling.h) for many nodes at once: quadtrees over layers of blocks, with the bounds
// of synthesis/field/field_content.h. A node has lists of the elements of the field that reach it, chosen
// from the lists of its parent.
#pragma once

#include "cuda/backend_lists.h"
#include "cuda/mesher/mesh_batch.h"
#include "synthesis/field/field_at_point.h"
#include "synthesis/field/field_content.h"
#include "synthesis/field/gathering.h"

namespace astrolith {

// A square of size x size blocks of layer z. A size of 0 means that the node lies outside the grid.
struct CullNode {
  int x, y, z, size;
};

// The numbers of lists of a node. Lists come in this order: metaballs of each leaf, craters of each layer of
// craters, boulders, and the wide lists of metaballs of each leaf. Only a field with Gabor noise has wide
// lists: the metaballs that reach the cells of impulses around the node.
struct NodeLists {
  std::uint32_t leaves, landforms, wide;

  ASTROLITH_HD std::uint32_t count() const { return leaves + landforms + wide; }
  ASTROLITH_HD bool is_boulders(std::uint32_t list) const { return list + 1 == leaves + landforms; }
  ASTROLITH_HD bool is_craters(std::uint32_t list) const {
    return list >= leaves && list + 1 < leaves + landforms;
  }
  // The number of the leaf of a list of metaballs.
  ASTROLITH_HD std::uint32_t leaf(std::uint32_t list) const {
    return list < leaves ? list : list - leaves - landforms;
  }
};

// Nodes in a backend's memory, and their lists.
struct CullNodes {
  const CullNode* nodes;
  const ListRange* ranges;  // (nodes, lists): where each list is in `numbers`
  const std::uint32_t* numbers;
};

// Each thread makes one quarter of a node.
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

// Writes list i % lists of node i / lists: the numbers of the parent's list whose elements reach the node.
struct NarrowLists {
  FieldView field;
  MeshGrid grid;
  NodeLists lists;
  double wide_margin;
  const CullNode* nodes;
  CullNodes parents;
  std::uint32_t nodes_a_parent;

  // Where the cells of Gabor impulses that may reach a block have their centres. Gabor noise of the body's
  // frame moves its points into the supports of the body's kernels; the domain of a patch's holds them where
  // they are.
  ASTROLITH_HD Box cells_around(const Box& box) const {
    const Box& supports = field.body.supports;
    const Box projected = projected_block(field, box);
    const Box inside = moved_into(projected, to_float(supports.min), to_float(supports.max));
    return widened(grid.in_patch ? united(inside, projected) : inside, wide_margin);
  }
  // The box that the elements of a list must reach.
  ASTROLITH_HD Box reached_box(const CullNode& node, std::uint32_t list) const {
    const Box box = grid.box_in_body(node.x, node.y, node.z, node.size);
    if (lists.is_boulders(list)) return box;
    if (lists.is_craters(list)) return projected_block(field, box);
    const Box at = list < lists.leaves ? body_box(field.body, field.arrays, box) : cells_around(box);
    return leaf_box(field.body, field.arrays, lists.leaf(list), at);
  }
  ASTROLITH_HD bool reaches(std::uint32_t list, std::uint32_t number, const Box& box) const {
    if (lists.is_boulders(list)) return boulder_reaches(field, number, box);
    if (lists.is_craters(list)) return crater_reaches(field, list - lists.leaves, number, box);
    const BodyLeaf& leaf = field.leaf(lists.leaf(list));
    return metaball_reaches(leaf, field.arrays[leaf.spheres][number], box);
  }
  template <typename Writer>
  ASTROLITH_HD void operator()(std::size_t i, ListShare share, Writer& write) const {
    const std::size_t n = i / lists.count();
    const auto list = static_cast<std::uint32_t>(i % lists.count());
    if (nodes[n].size == 0) return;
    const Box box = reached_box(nodes[n], list);
    const ListRange parent_range = parents.ranges[n / nodes_a_parent * lists.count() + list];
    const auto begin = parent_range.first + static_cast<std::uint32_t>(share.begin(parent_range.count)),
               end = parent_range.first + static_cast<std::uint32_t>(share.end(parent_range.count));
    for (std::uint32_t k = begin; k < end; ++k) {
      if (reaches(list, parents.numbers[k], box)) write(parents.numbers[k]);
    }
  }
};

// Each thread finds the range of one list, from the first elements of the list and of the next list.
struct MakeRanges {
  const std::uint32_t* first;
  ListRange* ranges;
  ASTROLITH_HD void operator()(std::size_t i) const { ranges[i] = {first[i], first[i + 1] - first[i]}; }
};

// The `Lists` of one node for field_content() (synthesis/field/field_content.h).
struct NodeFieldLists {
  const FieldView& field;
  const std::uint32_t* numbers;
  const ListRange* ranges;  // (lists)

  ASTROLITH_HD MetaballList metaballs(std::uint32_t leaf) const {
    return {field.arrays[field.leaf(leaf).spheres], numbers + ranges[leaf].first, ranges[leaf].count};
  }
  ASTROLITH_HD Interval bound_spots(const SpotNoise& noise, std::uint32_t, const Box& box) const {
    return bound_heights(noise, field.arrays, box);
  }
  template <class Visit>
  ASTROLITH_HD void for_each_crater(const CraterRelief& relief, const Box& box, const Visit& visit) const {
    const ListRange range = ranges[field.body.leaves.count + relief.list];
    for (std::uint32_t k = range.first; k < range.first + range.count; ++k) {
      if (crater_reaches(field, relief.list, numbers[k], box)) visit(numbers[k]);
    }
  }
  ASTROLITH_HD bool boulder_reaches(const Box& box) const {
    const ListRange range = ranges[field.body.leaves.count + field.boulder_list()];
    for (std::uint32_t k = range.first; k < range.first + range.count; ++k) {
      if (astrolith::boulder_reaches(field, numbers[k], box)) return true;
    }
    return false;
  }
};

// Each thread sets the flag of one node: 1 if the surface may cross the node, 0 otherwise.
struct FlagMixed {
  FieldView field;
  MeshGrid grid;
  NodeLists lists;
  CullNodes nodes;
  KernelInterval* scratch;  // (numbers): each node uses the elements of its own lists
  std::uint32_t* flags;
  std::uint32_t* failure;  // a MeshFailure

  ASTROLITH_HD void operator()(std::size_t i) const {
    const CullNode node = nodes.nodes[i];
    flags[i] = 0;
    if (node.size == 0) return;
    const NodeFieldLists node_lists{field, nodes.numbers, nodes.ranges + i * lists.count()};
    Interval kept[kMostKeptHeights];
    const BlockContent content =
        field_content(field, node_lists, grid.box_in_body(node.x, node.y, node.z, node.size),
                      {scratch + node_lists.ranges[0].first, kept});
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

// Each thread copies one node and its ranges if the node's flag is set. The nodes keep their order.
struct KeepMixed {
  std::uint32_t lists;
  CullNodes from;
  const std::uint32_t* place;  // (nodes + 1): running sum of the flags
  CullNode* nodes;
  ListRange* ranges;

  ASTROLITH_HD void operator()(std::size_t i) const {
    const std::uint32_t to = place[i];
    if (place[i + 1] == to) return;
    nodes[to] = from.nodes[i];
    for (std::uint32_t l = 0; l < lists; ++l) ranges[to * lists + l] = from.ranges[i * lists + l];
  }
};

// Each thread marks the place of one block among all blocks of the layers from `first_z` on, in the order of
// z, y and x.
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
// Each thread copies one block and its ranges to the block's place. `places.marks` holds the running sum of
// the marks.
struct OrderBlocks {
  MarkBlocks places;
  std::uint32_t lists;
  const ListRange* from_ranges;
  CullNode* nodes;
  ListRange* ranges;

  ASTROLITH_HD void operator()(std::size_t i) const {
    const CullNode node = places.nodes[i];
    const std::uint32_t to = places.marks[places.slot(node)];
    nodes[to] = node;
    for (std::uint32_t l = 0; l < lists; ++l) ranges[to * lists + l] = from_ranges[i * lists + l];
  }
};

}  // namespace astrolith
