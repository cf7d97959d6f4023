// The impulses of one bandwidth of surface noise, in bricks of cells. Bricks are kept while there is room,
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

// The impulses of a brick in the order of their cells (z, then y, then x), and a box that holds their
// supports.
struct GaborBrick {
  std::vector<ImpulseChunk> chunks;
  std::array<float, 3> low, high;
};

// The kept bricks of one band. They lie in shards with a lock each, so that threads seldom wait for each
// other.
struct GaborBrickCache {
  struct Shard {
    std::mutex mutex;
    std::unordered_map<std::uint64_t, std::shared_ptr<const GaborBrick>> bricks;
    std::deque<std::uint64_t> oldest_first;
    std::size_t bytes = 0;
    std::int64_t drawn = 0, drawn_bytes = 0;  // of all bricks that were ever kept
  };
  static constexpr std::size_t kShards = 64;

  std::unique_ptr<std::array<Shard, kShards>> shards = std::make_unique<std::array<Shard, kShards>>();
};

// What a cache holds and has held.
struct GaborCacheUse {
  double held_bytes = 0.0;
  double drawn = 0.0;        // number of bricks that were ever kept
  double drawn_bytes = 0.0;  // memory of all of these
};
GaborCacheUse cache_use(const GaborBrickCache& cache);
// The most memory of a cache, bytes.
inline constexpr double kMostCacheBytes = double(GaborBrickCache::kShards) * (1 << 19);

// The bricks of one band on a body. The members may be called from many threads.
class GaborBricks {
 public:
  // `cache` must belong to this band on this body. All three arguments must outlive the object.
  GaborBricks(const SurfaceBand& band, const BodyGround& ground, const GaborBrickCache& cache)
      : band_(band), ground_(ground), cache_(cache) {}

  const SurfaceBand& band() const { return band_; }
  const BodyGround& ground() const { return ground_; }

  // The brick whose first cell is kBrickCells times the index. It is drawn unless the cache holds it.
  std::shared_ptr<const GaborBrick> brick(const std::array<int, 3>& index) const;

  // Seconds of one processor to draw a brick, keep it and let it go, from some of those in the cache, which
  // are drawn again. 0 where the cache is empty.
  double seconds_per_brick() const;

 private:
  std::shared_ptr<const GaborBrick> draw(const std::array<int, 3>& index) const;

  const SurfaceBand& band_;
  const BodyGround& ground_;
  const GaborBrickCache& cache_;
};

}  // namespace astrolith
