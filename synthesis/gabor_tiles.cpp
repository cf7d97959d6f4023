#include "synthesis/gabor_tiles.h"

#include "numerics/hash_random.h"

namespace astrolith {
namespace {

constexpr std::size_t kMostShelfBytes = std::size_t{1} << 19;  // 32 MB a band in all

// Indices stay below 2^20 in magnitude.
std::uint64_t key_of(const std::array<int, 3>& index) {
  std::uint64_t key = 0;
  for (const int i : index) key = key << 21 | (static_cast<std::uint32_t>(i) & 0x1fffffu);
  return key;
}

std::size_t bytes_of(const DrawnCells& tile) {
  return sizeof(tile) + tile.impulses.capacity() * sizeof(GaborImpulse) +
         tile.start.capacity() * sizeof(std::uint32_t);
}

}  // namespace

GaborTiles::GaborTiles(SurfaceBand band, const PreparedBody& body)
    : band_(std::move(band)), body_(body), shelves_(std::make_unique<std::array<Shelf, kShelves>>()) {}

std::shared_ptr<const DrawnCells> GaborTiles::tile(const std::array<int, 3>& index) const {
  const std::uint64_t key = key_of(index);
  Shelf& shelf = (*shelves_)[hash_cell(0, index[0], index[1], index[2]) % kShelves];
  {
    const std::lock_guard lock(shelf.mutex);
    const auto known = shelf.tiles.find(key);
    if (known != shelf.tiles.end()) return known->second;
  }
  auto made = std::make_shared<const DrawnCells>(make_tile(index));
  const std::lock_guard lock(shelf.mutex);
  const auto [place, is_new] = shelf.tiles.emplace(key, made);
  if (!is_new) return place->second;  // another thread was faster
  shelf.oldest_first.push_back(key);
  shelf.bytes += bytes_of(*made);
  while (shelf.bytes > kMostShelfBytes && shelf.oldest_first.size() > 1) {
    const auto oldest = shelf.tiles.find(shelf.oldest_first.front());
    shelf.bytes -= bytes_of(*oldest->second);
    shelf.tiles.erase(oldest);
    shelf.oldest_first.pop_front();
  }
  return made;
}

DrawnCells GaborTiles::make_tile(const std::array<int, 3>& index) const {
  std::vector<GaborCell> cells;
  for (int z = 0; z < kTileCells; ++z) {
    for (int y = 0; y < kTileCells; ++y) {
      for (int x = 0; x < kTileCells; ++x) {
        cells.push_back({index[0] * kTileCells + x, index[1] * kTileCells + y, index[2] * kTileCells + z});
      }
    }
  }
  DrawnCells tile = draw_cells(band_, body_, cells);
  tile.impulses.shrink_to_fit();
  return tile;
}

}  // namespace astrolith
