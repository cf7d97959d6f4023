#include "cuda/mesher/mesh_batch.h"

namespace astrolith {
namespace {

// The indices of a layer and of the layers below and above it; null where a layer is not known.
struct Neighbours {
  const LayerIndex* below;
  const LayerIndex* same;
  const LayerIndex* above;
  bool below_is_in_batch;
};

std::array<std::int32_t, 8> find_owners(const Neighbours& n, int x, int y, std::int32_t own) {
  std::array<std::int32_t, 8> owners;
  owners.fill(BlockPlace::kNone);
  for (int i = 1; i < 8; ++i) {
    const bool down = (i & 4) != 0;
    const LayerIndex* where = down ? n.below : n.same;
    const int ox = x - (i & 1), oy = y - ((i >> 1) & 1);
    if (where == nullptr || !where->has(ox, oy)) continue;
    const std::int32_t number = where->at(ox, oy);
    owners[static_cast<unsigned>(i)] = down && !n.below_is_in_batch ? -1 - number : number;
  }
  owners[0] = own;
  return owners;
}

std::uint32_t lacking_sides(const Neighbours& n, int x, int y) {
  const auto lacks = [](const LayerIndex* where, int bx, int by) {
    return where != nullptr && where->contains(bx, by) && !where->has(bx, by);
  };
  const bool sides[] = {lacks(n.same, x - 1, y), lacks(n.same, x + 1, y), lacks(n.same, x, y - 1),
                        lacks(n.same, x, y + 1), lacks(n.below, x, y),    lacks(n.above, x, y)};
  std::uint32_t bits = 0;
  for (unsigned s = 0; s < 6; ++s) bits |= sides[s] ? 1u << s : 0u;
  return bits;
}

// The numbers, within its layer, of the first block of a row of blocks and of the block after its last.
struct BlockRow {
  std::size_t first, end;
};
BlockRow row_around(std::span<const BlockColumn> layer, std::size_t i) {
  BlockRow row{i, i + 1};
  while (row.first > 0 && layer[row.first - 1].y == layer[i].y) --row.first;
  while (row.end < layer.size() && layer[row.end].y == layer[i].y) ++row.end;
  return row;
}

}  // namespace

MeshGrid field_grid(const Box& bounds, int resolution, MeshTile tile) {
  const SampleGrid samples = make_sample_grid(bounds, resolution);
  return {{samples, tile_window<kBlockCells>(samples, tile), true}};
}

MeshGrid patch_grid(const PatchPlace& place, double size, int resolution) {
  const SampleGrid samples = make_patch_grid(size, resolution);
  return {{samples, patch_window(samples), false}, true, place};
}

double block_side(const MeshGrid& grid) { return grid.box_in_body(0, 0, 0, 1).longest_side(); }

std::vector<BlockPlace> place_blocks(const MeshGrid& grid, int first_z,
                                     std::span<const std::vector<BlockColumn>> layers,
                                     const LayerIndex& below, LayerIndex& last) {
  std::vector<LayerIndex> index(layers.size(), LayerIndex(grid.blocks(0), grid.blocks(1)));
  std::int32_t count = 0;
  for (std::size_t l = 0; l < layers.size(); ++l) {
    for (const BlockColumn& c : layers[l]) index[l].set(c.x, c.y, count++);
  }
  std::vector<BlockPlace> places;
  for (std::size_t l = 0; l < layers.size(); ++l) {
    const bool has_below = l > 0 || below.contains(0, 0);
    const Neighbours n{has_below ? (l > 0 ? &index[l - 1] : &below) : nullptr, &index[l],
                       l + 1 < layers.size() ? &index[l + 1] : nullptr, l > 0};
    const std::vector<BlockColumn>& layer = layers[l];
    const auto first = static_cast<std::uint32_t>(places.size());
    BlockRow row{0, 0};
    for (std::size_t i = 0; i < layer.size(); ++i) {
      if (i == row.end) row = row_around(layer, i);
      const BlockColumn c = layer[i];
      const auto own = static_cast<std::int32_t>(places.size());
      places.push_back({c.x, c.y, first_z + static_cast<int>(l), find_owners(n, c.x, c.y, own),
                        lacking_sides(n, c.x, c.y), first, static_cast<std::uint32_t>(layer.size()),
                        first + static_cast<std::uint32_t>(row.first),
                        static_cast<std::uint32_t>(row.end - row.first)});
    }
  }
  // `last` counts blocks from 0 within the last layer.
  last = LayerIndex(grid.blocks(0), grid.blocks(1));
  std::int32_t number = 0;
  for (const BlockColumn& c : layers.back()) last.set(c.x, c.y, number++);
  return places;
}

std::vector<std::uint32_t> lacking_above(std::span<const BlockColumn> columns, const LayerIndex& above) {
  std::vector<std::uint32_t> lacking;
  for (const BlockColumn& c : columns) {
    lacking.push_back(above.contains(c.x, c.y) && !above.has(c.x, c.y) ? 1u << 5 : 0u);
  }
  return lacking;
}

}  // namespace astrolith
