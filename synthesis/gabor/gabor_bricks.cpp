#include "synthesis/gabor/gabor_bricks.h"

#include <algorithm>
#include <limits>

#include "numerics/hash_random.h"
#include "numerics/processor_clock.h"

namespace astrolith {
namespace {

constexpr auto kMostShardBytes = static_cast<std::size_t>(kMostCacheBytes / GaborBrickCache::kShards);

// The key of a brick. Indices are below 2^20 in magnitude, since cells are counted from the frame's origin.
std::uint64_t pack_index(const std::array<int, 3>& index) {
  std::uint64_t key = 0;
  for (const int i : index) key = key << 21 | (static_cast<std::uint32_t>(i) & 0x1fffffu);
  return key;
}

std::array<int, 3> unpack_index(std::uint64_t key) {
  std::array<int, 3> index;
  for (int i = 2; i >= 0; --i, key >>= 21) {
    const auto bits = static_cast<std::int32_t>(key & 0x1fffffu);
    index[static_cast<std::size_t>(i)] = bits >= 0x100000 ? bits - 0x200000 : bits;
  }
  return index;
}

std::size_t count_bytes(const GaborBrick& brick) {
  constexpr std::size_t kBookkeeping = 160;  // of the map, the queue, the shared pointer and the allocator
  return kBookkeeping + sizeof(brick) + brick.chunks.capacity() * sizeof(ImpulseChunk);
}

}  // namespace

GaborCacheUse cache_use(const GaborBrickCache& cache) {
  GaborCacheUse use;
  for (GaborBrickCache::Shard& shard : *cache.shards) {
    const std::lock_guard lock(shard.mutex);
    use.held_bytes += static_cast<double>(shard.bytes);
    use.drawn += static_cast<double>(shard.drawn);
    use.drawn_bytes += static_cast<double>(shard.drawn_bytes);
  }
  return use;
}

std::shared_ptr<const GaborBrick> GaborBricks::brick(const std::array<int, 3>& index) const {
  const std::uint64_t key = pack_index(index);
  GaborBrickCache::Shard& shard =
      (*cache_.shards)[hash_cell(0, index[0], index[1], index[2]) % GaborBrickCache::kShards];
  {
    const std::lock_guard lock(shard.mutex);
    const auto known = shard.bricks.find(key);
    if (known != shard.bricks.end()) return known->second;
  }
  const std::shared_ptr<const GaborBrick> made = draw(index);
  const std::lock_guard lock(shard.mutex);
  const auto [place, is_new] = shard.bricks.emplace(key, made);
  if (!is_new) return place->second;  // another thread was faster
  shard.oldest_first.push_back(key);
  shard.bytes += count_bytes(*made);
  ++shard.drawn;
  shard.drawn_bytes += static_cast<std::int64_t>(count_bytes(*made));
  while (shard.bytes > kMostShardBytes && shard.oldest_first.size() > 1) {
    const auto oldest = shard.bricks.find(shard.oldest_first.front());
    shard.bytes -= count_bytes(*oldest->second);
    shard.bricks.erase(oldest);
    shard.oldest_first.pop_front();
  }
  return made;
}

double GaborBricks::seconds_per_brick() const {
  constexpr std::size_t kMostInShard = 6;
  std::vector<std::uint64_t> keys;
  for (GaborBrickCache::Shard& shard : *cache_.shards) {
    const std::lock_guard lock(shard.mutex);
    for (std::size_t i = 0; i < std::min(kMostInShard, shard.oldest_first.size()); ++i)
      keys.push_back(shard.oldest_first[i]);
  }
  if (keys.empty()) return 0.0;
  const ProcessorClock clock;
  {
    const GaborBrickCache empty;
    const GaborBricks again(band_, ground_, empty);
    for (const std::uint64_t key : keys) again.brick(unpack_index(key));
  }
  return clock.seconds() / double(keys.size());
}

std::shared_ptr<const GaborBrick> GaborBricks::draw(const std::array<int, 3>& index) const {
  BrickCells cells;
  for (int i = 0; i < static_cast<int>(kBrickVolume); ++i) {
    cells[static_cast<std::size_t>(i)] = {index[0] * kBrickCells + i % kBrickCells,
                                          index[1] * kBrickCells + i / kBrickCells % kBrickCells,
                                          index[2] * kBrickCells + i / (kBrickCells * kBrickCells)};
  }
  constexpr float kInfinity = std::numeric_limits<float>::infinity();
  GaborBrick brick{make_chunks(draw_cells(band_, ground_, cells), double{band_.a}),
                   {kInfinity, kInfinity, kInfinity},
                   {-kInfinity, -kInfinity, -kInfinity}};
  for (const ImpulseChunk& chunk : brick.chunks) {
    for (std::size_t axis = 0; axis < 3; ++axis) {
      brick.low[axis] = std::min(brick.low[axis], chunk.low[axis]);
      brick.high[axis] = std::max(brick.high[axis], chunk.high[axis]);
    }
  }
  return std::make_shared<const GaborBrick>(std::move(brick));
}

}  // namespace astrolith
