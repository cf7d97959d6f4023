// The impulses of one bandwidth of surface noise in tiles of cells, kept while there is room: neighbouring
// blocks of a mesh, and its samples and its normals, need the same ones.
#pragma once

#include <array>
#include <cstdint>
#include <deque>
#include <memory>
#include <mutex>
#include <unordered_map>

#include "synthesis/gabor_cells.h"

namespace astrolith {

// Cells along a tile's side.
inline constexpr int kTileCells = 4;

class GaborTiles {
 public:
  GaborTiles(SurfaceBand band, const PreparedBody& body);

  const SurfaceBand& band() const { return band_; }
  const PreparedBody& body() const { return body_; }

  // The tile whose first cell is kTileCells times the index; its cells are counted along x, then y, then z.
  // May be called from many threads.
  std::shared_ptr<const DrawnCells> tile(const std::array<int, 3>& index) const;

 private:
  // Locked one by one, so that threads seldom wait for each other.
  struct Shelf {
    std::mutex mutex;
    std::unordered_map<std::uint64_t, std::shared_ptr<const DrawnCells>> tiles;
    std::deque<std::uint64_t> oldest_first;
    std::size_t bytes = 0;
  };
  static constexpr std::size_t kShelves = 64;

  DrawnCells make_tile(const std::array<int, 3>& index) const;

  SurfaceBand band_;
  PreparedBody body_;
  std::unique_ptr<std::array<Shelf, kShelves>> shelves_;
};

}  // namespace astrolith
