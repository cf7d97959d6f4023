// Finds the blocks of some layers that the surface may cross, on a backend. They are found as mixed_blocks
// (synthesis/mesh/block_culling.h) finds them, by the bounds of field_content(). The CPU has tighter bounds
// for small boxes, and leaves out some blocks that the surface does not cross. Each block comes with lists of
// the elements of the field that reach it.
#pragma once

#include <bit>
#include <vector>

#include "cuda/field_on_backend.h"
#include "cuda/mesher/cull_steps.h"

namespace astrolith {

// Blocks sorted by layer, row and column.
template <class Backend>
struct CulledBlocks {
  typename Backend::template Array<CullNode> nodes;
  typename Backend::template Array<ListRange> ranges;       // (nodes, lists): where each list is in `numbers`
  typename Backend::template Array<std::uint32_t> numbers;  // numbers of metaballs, craters and boulders
  std::vector<CullNode> on_host;                            // a copy of `nodes`

  CullNodes view() const { return {nodes.data(), ranges.data(), numbers.data()}; }
};

template <class Backend>
class BlockCuller {
 public:
  template <typename T>
  using Array = typename Backend::template Array<T>;

  // `field` is on the host, `on_backend` in the backend's memory. If wide_margin (length units) is not 0,
  // nodes also get wide lists: the metaballs that reach their projected_block()
  // (synthesis/field/gathering.h), widened by wide_margin.
  BlockCuller(Backend& backend, const FieldView& field, const FieldView& on_backend, const MeshGrid& grid,
              double wide_margin)
      : backend_(backend),
        field_(on_backend),
        grid_(grid),
        lists_{field.body.leaves.count, field.num_landform_lists(),
               wide_margin > 0.0 ? field.body.leaves.count : 0},
        wide_margin_(wide_margin) {
    std::vector<ListRange> ranges;
    std::vector<std::uint32_t> numbers;
    const auto add_all = [&](std::uint32_t count) {
      ranges.push_back({static_cast<std::uint32_t>(numbers.size()), count});
      for (std::uint32_t k = 0; k < count; ++k) numbers.push_back(k);
    };
    const auto add_leaves = [&] {
      for (std::uint32_t leaf = 0; leaf < lists_.leaves; ++leaf) add_all(field.leaf(leaf).spheres.count);
    };
    add_leaves();
    for (std::uint32_t list = 0; list < field.crater_layers.count; ++list)
      add_all(field.craters(list).craters.count);
    add_all(field.boulders.count);
    if (lists_.wide != 0) add_leaves();
    all_ranges_ = backend.upload(std::span<const ListRange>(ranges));
    all_numbers_ = backend.upload(std::span<const std::uint32_t>(numbers));
  }

  const NodeLists& lists() const { return lists_; }

  // The blocks of layers first_z .. first_z + count - 1. `failure` becomes MeshFailure::kBorder where the
  // body fills a block at the border of the grid.
  CulledBlocks<Backend> cull(int first_z, int count, Array<std::uint32_t>& failure) {
    const int size = root_size(count);
    std::vector<CullNode> roots;
    for (int z = first_z; z < first_z + count; ++z) {
      for (int y = 0; y < grid_.blocks(1); y += size) {
        for (int x = 0; x < grid_.blocks(0); x += size) roots.push_back({x, y, z, size});
      }
    }
    Level level{backend_.upload(std::span<const CullNode>(roots)), {}, {}};
    narrow(CullNodes{nullptr, all_ranges_.data(), all_numbers_.data()},
           static_cast<std::uint32_t>(roots.size()), level);
    for (int s = size; s > 1 && level.nodes.size() != 0; s /= 2) level = mixed_quarters(level, failure);
    return ordered(level, first_z, count);
  }

 private:
  // The size of the nodes that culling begins with: so small that they keep a GPU at work, but not so small
  // that choosing their lists from all elements costs more than the levels above them.
  int root_size(int layers) const {
    constexpr double kMostRoots = 4096.0, kMostChoices = 1 << 24;
    const auto longest = static_cast<unsigned>(std::max(grid_.blocks(0), grid_.blocks(1)));
    int size = std::max(2, static_cast<int>(std::bit_ceil(longest)));
    const auto roots = [&](int s) {
      const int along_x = (grid_.blocks(0) + s - 1) / s, along_y = (grid_.blocks(1) + s - 1) / s;
      return double(layers) * along_x * along_y;
    };
    while (size > 2 && roots(size / 2) <= kMostRoots &&
           roots(size / 2) * double(all_numbers_.size()) <= kMostChoices) {
      size /= 2;
    }
    return size;
  }

  // The nodes of one level of the quadtrees, and their lists.
  struct Level {
    Array<CullNode> nodes;
    Array<ListRange> ranges;
    Array<std::uint32_t> numbers;

    CullNodes view() const { return {nodes.data(), ranges.data(), numbers.data()}; }
  };

  // Makes the lists of a level's nodes from the lists of their parents. Each parent has `nodes_a_parent`
  // nodes.
  void narrow(const CullNodes& parents, std::uint32_t nodes_a_parent, Level& level) {
    const std::size_t lists = level.nodes.size() * lists_.count();
    auto narrowed = write_lists<std::uint32_t>(
        backend_, "narrowing lists", lists,
        NarrowLists{field_, grid_, lists_, wide_margin_, level.nodes.data(), parents, nodes_a_parent},
        share_count(lists));
    level.ranges = backend_.template allocate<ListRange>(lists);
    backend_.launch("finding lists", lists, MakeRanges{narrowed.first.data(), level.ranges.data()});
    level.numbers = std::move(narrowed.items);
  }

  // The quarters of a level's nodes that the surface may cross.
  Level mixed_quarters(const Level& level, Array<std::uint32_t>& failure) {
    const std::size_t n = 4 * level.nodes.size();
    Level quarters{backend_.template allocate<CullNode>(n), {}, {}};
    backend_.launch("quartering nodes", n, MakeQuarters{grid_, level.nodes.data(), quarters.nodes.data()});
    narrow(level.view(), 4, quarters);
    auto scratch = backend_.template allocate<KernelInterval>(quarters.numbers.size());
    auto flags = zeros_on<std::uint32_t>(backend_, n + 1);
    backend_.launch(
        "bounding nodes", n,
        FlagMixed{field_, grid_, lists_, quarters.view(), scratch.data(), flags.data(), failure.data()});
    backend_.running_sum(flags);
    const std::size_t kept = backend_.read(flags, n);
    Level mixed{backend_.template allocate<CullNode>(kept),
                backend_.template allocate<ListRange>(kept * lists_.count()),
                {}};
    backend_.launch(
        "keeping nodes", n,
        KeepMixed{lists_.count(), quarters.view(), flags.data(), mixed.nodes.data(), mixed.ranges.data()});
    mixed.numbers = std::move(quarters.numbers);
    return mixed;
  }

  // The nodes of the last level, which are single blocks, sorted by layer, row and column.
  CulledBlocks<Backend> ordered(Level& level, int first_z, int count) {
    const std::size_t n = level.nodes.size();
    auto marks = zeros_on<std::uint32_t>(backend_, static_cast<std::size_t>(count) *
                                                       static_cast<std::size_t>(grid_.blocks(0)) *
                                                       static_cast<std::size_t>(grid_.blocks(1)));
    const MarkBlocks mark{grid_, first_z, level.nodes.data(), marks.data()};
    backend_.launch("marking blocks", n, mark);
    backend_.running_sum(marks);
    CulledBlocks<Backend> blocks{backend_.template allocate<CullNode>(n),
                                 backend_.template allocate<ListRange>(n * lists_.count()),
                                 std::move(level.numbers), std::vector<CullNode>(n)};
    backend_.launch(
        "ordering blocks", n,
        OrderBlocks{mark, lists_.count(), level.ranges.data(), blocks.nodes.data(), blocks.ranges.data()});
    backend_.download(blocks.nodes, std::span(blocks.on_host));
    return blocks;
  }

  Backend& backend_;
  FieldView field_;
  MeshGrid grid_;
  NodeLists lists_;
  double wide_margin_;
  Array<ListRange> all_ranges_;
  Array<std::uint32_t> all_numbers_;
};

}  // namespace astrolith
