// The impulses of one bandwidth of surface noise, in tiles of cells. Tiles are kept while there is room,
// since neighbouring blocks of a mesh, and the samples and normals of one block, need the same impulses.
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

// The impulses of a tile in the order of their cells (z, then y, then x), and a box that holds their
// supports.
struct GaborTile {
  std::vector<ImpulseChunk> chunks;
  std::array<float, 3> low, high;
};

// The kept tiles of one band. They lie on shelves with a lock each, so that threads seldom wait for each
// other.
struct GaborTileCache {
  struct Shelf {
    std::mutex mutex;
    std::unordered_map<std::uint64_t, std::shared_ptr<const GaborTile>> tiles;
    std::deque<std::uint64_t> oldest_first;
    std::size_t bytes = 0;
    std::int64_t drawn = 0, drawn_bytes = 0;  // of all tiles that were ever kept
  };
  static constexpr std::size_t kShelves = 64;

  std::unique_ptr<std::array<Shelf, kShelves>> shelves = std::make_unique<std::array<Shelf, kShelves>>();
};

// What a cache holds and has held.
struct GaborCacheUse {
  double held_bytes = 0.0;
  double drawn = 0.0;        // number of tiles that were ever kept
  double drawn_bytes = 0.0;  // memory of all of these
};
GaborCacheUse use_of(const GaborTileCache& cache);
// The most memory of a cache, bytes.
inline constexpr double kMostCacheBytes = double(GaborTileCache::kShelves) * (1 << 19);

// The tiles of one band on a body. The members may be called from many threads.
class GaborTiles {
 public:
  // `cache` must belong to this band on this body. All three arguments must outlive the object.
  GaborTiles(const SurfaceBand& band, const BodyGround& ground, const GaborTileCache& cache)
      : band_(band), ground_(ground), cache_(cache) {}

  const SurfaceBand& band() const { return band_; }
  const BodyGround& ground() const { return ground_; }

  // The tile whose first cell is kTileCells times the index. It is drawn unless the cache holds it.
  std::shared_ptr<const GaborTile> tile(const std::array<int, 3>& index) const;

  // Seconds of one processor to draw a tile, keep it and let it go, from some of those in the cache, which
  // are drawn again. 0 where the cache is empty.
  double seconds_of_tile() const;

 private:
  std::shared_ptr<const GaborTile> draw(const std::array<int, 3>& index) const;

  const SurfaceBand& band_;
  const BodyGround& ground_;
  const GaborTileCache& cache_;
};

}  // namespace astrolith
