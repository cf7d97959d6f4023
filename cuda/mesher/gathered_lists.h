// The lists of the elements that reach some blocks (synthesis/field/field_tables.h), gathered on the backend
// that uses them. Each step writes the items of list number i, by the rules of synthesis/field/gathering.h.
#pragma once

#include "cuda/mesher/block_culler.h"
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
    return grid.box_in_body(n.x, n.y, n.z, 1);
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
  ASTROLITH_HD void operator()(std::size_t i, ListShare, Writer& write) const {
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
  ASTROLITH_HD void operator()(std::size_t i, ListShare, Writer& write) const {
    const ListRange range =
        from.range(i / from.lists.landforms, from.lists.leaves + i % from.lists.landforms);
    for (std::uint32_t k = range.first; k < range.first + range.count; ++k) write(from.blocks.numbers[k]);
  }
};

// Writes the spots of spot list i % lists that reach block i / lists.
struct GatherSpots {
  GatherFrom from;

  template <typename Writer>
  ASTROLITH_HD void operator()(std::size_t i, ListShare share, Writer& write) const {
    const std::uint32_t lists = from.field.spot_lists.count;
    gather_spots(from.field, static_cast<std::uint32_t>(i % lists), from.box(i / lists), write, share);
  }
};

// Writes the impulses of Gabor list i % lists that may reach block i / lists.
template <Frame frame>
struct GatherGabor {
  GatherFrom from;
  LeafLists metaballs;  // the wide lists of all blocks

  template <typename Writer>
  ASTROLITH_HD void operator()(std::size_t i, ListShare share, Writer& write) const {
    const std::uint32_t lists = from.field.gabor_lists.count;
    const LeafLists block_lists{metaballs.spheres, metaballs.first + i / lists * from.lists.leaves};
    gather_gabor<frame>(from.field, static_cast<std::uint32_t>(i % lists), block_lists, from.box(i / lists),
                        write, share);
  }
};

template <class Backend>
class GatheredLists {
 public:
  // Gathers the lists of the first `count` blocks of `from`.
  GatheredLists(Backend& backend, const GatherFrom& from, std::size_t count)
      : leaves_(from.lists.leaves),
        spot_lists_(from.field.spot_lists.count),
        gabor_lists_(from.field.gabor_lists.count),
        landform_lists_(from.lists.landforms),
        metaballs_(write_lists<MetaballSphere<float>>(backend, "gathering metaballs", count * leaves_,
                                                      GatherMetaballs{from, 0})),
        landforms_(write_lists<std::uint32_t>(backend, "gathering craters and boulders",
                                              count * landform_lists_, GatherLandforms{from})),
        spots_(write_lists<SpotImpulse>(backend, "gathering spots", count * spot_lists_, GatherSpots{from},
                                        share_count(count * spot_lists_))),
        gabor_(from.grid.in_patch ? gather_gabor_lists<Frame::kPatch>(backend, from, count)
                                  : gather_gabor_lists<Frame::kBody>(backend, from, count)) {}

  // The lists in the backend's memory. The view is valid while this object lives.
  BlockListArrays view() const {
    return {metaballs_.items.data(),
            metaballs_.first.data(),
            spots_.items.data(),
            spots_.first.data(),
            gabor_.items.data(),
            gabor_.first.data(),
            landforms_.items.data(),
            landforms_.first.data(),
            leaves_,
            spot_lists_,
            gabor_lists_,
            landform_lists_};
  }

 private:
  template <Frame frame>
  BackendLists<Backend, GaborImpulse> gather_gabor_lists(Backend& backend, const GatherFrom& from,
                                                         std::size_t count) {
    using Gather = GatherGabor<frame>;
    if (gabor_lists_ == 0) return write_lists<GaborImpulse>(backend, "gathering", 0, Gather{});
    // The frames of impulses follow from the body at the centres of their cells, which lie around the blocks.
    const auto wide =
        write_lists<MetaballSphere<float>>(backend, "gathering metaballs", count * leaves_,
                                           GatherMetaballs{from, from.lists.leaves + from.lists.landforms});
    return write_lists<GaborImpulse>(backend, "gathering Gabor impulses", count * gabor_lists_,
                                     Gather{from, {wide.items.data(), wide.first.data()}},
                                     share_count(count * gabor_lists_));
  }

  std::uint32_t leaves_, spot_lists_, gabor_lists_, landform_lists_;
  BackendLists<Backend, MetaballSphere<float>> metaballs_;
  BackendLists<Backend, std::uint32_t> landforms_;
  BackendLists<Backend, SpotImpulse> spots_;
  BackendLists<Backend, GaborImpulse> gabor_;
};

}  // namespace astrolith
