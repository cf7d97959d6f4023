// The impulses of one bandwidth of surface noise in tiles of cells, kept while there is room: neighbouring
// blocks of a mesh, and its samples and its normals, need the same ones.
#pragma once

#include <array>
#include <cstdint>
#include <deque>
#include <memory>
#include <mutex>
#include <unordered_map>

#include "synthesis/gabor/gabor_cells.h"
#include "synthesis/gabor/gabor_chunk.h"

namespace astrolith {

// Impulses in the order of their cells (z, then y, then x), and a box that holds their supports.
struct GaborTile {
  std::vector<ImpulseChunk> chunks;
  std::array<float, 3> low, high;
};

// Some of a tile's cells: bit (z * kTileCells + y) * kTileCells + x.
using TileCells = std::uint64_t;
inline constexpr TileCells kWholeTile = ~TileCells{0};

// The tiles of one band that are kept. They are locked one by one, so that threads seldom wait for each
// other.
struct GaborTileCache {
  struct Shelf {
    std::mutex mutex;
    std::unordered_map<std::uint64_t, std::shared_ptr<const GaborTile>> tiles;
    std::deque<std::uint64_t> oldest_first;
    std::size_t bytes = 0;
  };
  static constexpr std::size_t kShelves = 64;

  std::unique_ptr<std::array<Shelf, kShelves>> shelves = std::make_unique<std::array<Shelf, kShelves>>();
};

// The tiles of one band on a body. Members may be called from many threads.
class GaborTiles {
 public:
  // `cache` holds tiles of this band on this body alone. All three must outlive the object.
  GaborTiles(const SurfaceBand& band, const GaborGround& ground, const GaborTileCache& cache)
      : band_(band), ground_(ground), cache_(cache) {}

  const SurfaceBand& band() const { return band_; }

  // The tile whose first cell is kTileCells times the index.
  std::shared_ptr<const GaborTile> tile(const std::array<int, 3>& index) const;

  // The tile with the impulses of some cells alone, drawn anew.
  std::shared_ptr<const GaborTile> draw(const std::array<int, 3>& index, TileCells cells) const;

 private:
  const SurfaceBand& band_;
  const GaborGround& ground_;
  const GaborTileCache& cache_;
};

}  // namespace astrolith
