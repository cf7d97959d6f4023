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

class GaborTiles {
 public:
  GaborTiles(SurfaceBand band, const PreparedBody& body);

  const SurfaceBand& band() const { return band_; }

  // The tile whose first cell is kTileCells times the index. May be called from many threads.
  std::shared_ptr<const GaborTile> tile(const std::array<int, 3>& index) const;

  // The same with the impulses of some cells alone, drawn anew.
  std::shared_ptr<const GaborTile> draw(const std::array<int, 3>& index, TileCells cells) const;

 private:
  // Locked one by one, so that threads seldom wait for each other.
  struct Shelf {
    std::mutex mutex;
    std::unordered_map<std::uint64_t, std::shared_ptr<const GaborTile>> tiles;
    std::deque<std::uint64_t> oldest_first;
    std::size_t bytes = 0;
  };
  static constexpr std::size_t kShelves = 64;

  SurfaceBand band_;
  PreparedBody body_;
  std::unique_ptr<std::array<Shelf, kShelves>> shelves_;
};

}  // namespace astrolith
