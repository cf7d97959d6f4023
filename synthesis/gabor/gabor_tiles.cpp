#include "synthesis/gabor/gabor_tiles.h"

#include <algorithm>
#include <limits>

#include "numerics/hash_random.h"
#include "numerics/processor_clock.h"

namespace astrolith {
namespace {

constexpr auto kMostShelfBytes = static_cast<std::size_t>(kMostCacheBytes / GaborTileCache::kShelves);

// The key of a tile. Indices are below 2^20 in magnitude, since cells are counted from the frame's origin.
std::uint64_t key_of(const std::array<int, 3>& index) {
  std::uint64_t key = 0;
  for (const int i : index) key = key << 21 | (static_cast<std::uint32_t>(i) & 0x1fffffu);
  return key;
}

std::array<int, 3> index_of(std::uint64_t key) {
  std::array<int, 3> index;
  for (int i = 2; i >= 0; --i, key >>= 21) {
    const auto bits = static_cast<std::int32_t>(key & 0x1fffffu);
    index[static_cast<std::size_t>(i)] = bits >= 0x100000 ? bits - 0x200000 : bits;
  }
  return index;
}

std::size_t bytes_of(const GaborTile& tile) {
  constexpr std::size_t kBookkeeping = 160;  // of the map, the queue, the shared pointer and the allocator
  return kBookkeeping + sizeof(tile) + tile.chunks.capacity() * sizeof(ImpulseChunk);
}

}  // namespace

GaborCacheUse use_of(const GaborTileCache& cache) {
  GaborCacheUse use;
  for (GaborTileCache::Shelf& shelf : *cache.shelves) {
    const std::lock_guard lock(shelf.mutex);
    use.held_bytes += static_cast<double>(shelf.bytes);
    use.drawn += static_cast<double>(shelf.drawn);
    use.drawn_bytes += static_cast<double>(shelf.drawn_bytes);
  }
  return use;
}

std::shared_ptr<const GaborTile> GaborTiles::tile(const std::array<int, 3>& index) const {
  const std::uint64_t key = key_of(index);
  GaborTileCache::Shelf& shelf =
      (*cache_.shelves)[hash_cell(0, index[0], index[1], index[2]) % GaborTileCache::kShelves];
  {
    const std::lock_guard lock(shelf.mutex);
    const auto known = shelf.tiles.find(key);
    if (known != shelf.tiles.end()) return known->second;
  }
  const std::shared_ptr<const GaborTile> made = draw(index);
  const std::lock_guard lock(shelf.mutex);
  const auto [place, is_new] = shelf.tiles.emplace(key, made);
  if (!is_new) return place->second;  // another thread was faster
  shelf.oldest_first.push_back(key);
  shelf.bytes += bytes_of(*made);
  ++shelf.drawn;
  shelf.drawn_bytes += static_cast<std::int64_t>(bytes_of(*made));
  while (shelf.bytes > kMostShelfBytes && shelf.oldest_first.size() > 1) {
    const auto oldest = shelf.tiles.find(shelf.oldest_first.front());
    shelf.bytes -= bytes_of(*oldest->second);
    shelf.tiles.erase(oldest);
    shelf.oldest_first.pop_front();
  }
  return made;
}

double GaborTiles::seconds_of_tile() const {
  constexpr std::size_t kOfShelf = 6;
  std::vector<std::uint64_t> keys;
  for (GaborTileCache::Shelf& shelf : *cache_.shelves) {
    const std::lock_guard lock(shelf.mutex);
    for (std::size_t i = 0; i < std::min(kOfShelf, shelf.oldest_first.size()); ++i)
      keys.push_back(shelf.oldest_first[i]);
  }
  if (keys.empty()) return 0.0;
  const ProcessorClock clock;
  {
    const GaborTileCache empty;
    const GaborTiles again(band_, ground_, empty);
    for (const std::uint64_t key : keys) again.tile(index_of(key));
  }
  return clock.seconds() / double(keys.size());
}

std::shared_ptr<const GaborTile> GaborTiles::draw(const std::array<int, 3>& index) const {
  TileCells cells;
  for (int i = 0; i < static_cast<int>(kTileVolume); ++i) {
    cells[static_cast<std::size_t>(i)] = {index[0] * kTileCells + i % kTileCells,
                                          index[1] * kTileCells + i / kTileCells % kTileCells,
                                          index[2] * kTileCells + i / (kTileCells * kTileCells)};
  }
  constexpr float kInfinity = std::numeric_limits<float>::infinity();
  GaborTile tile{make_chunks(draw_cells(band_, ground_, cells), double{band_.a}),
                 {kInfinity, kInfinity, kInfinity},
                 {-kInfinity, -kInfinity, -kInfinity}};
  for (const ImpulseChunk& chunk : tile.chunks) {
    for (std::size_t axis = 0; axis < 3; ++axis) {
      tile.low[axis] = std::min(tile.low[axis], chunk.low[axis]);
      tile.high[axis] = std::max(tile.high[axis], chunk.high[axis]);
    }
  }
  return std::make_shared<const GaborTile>(std::move(tile));
}

}  // namespace astrolith
