// The places of a relief, sorted into small tiles for evaluation.
//
// Space is cut into cubic cells, kReliefCell spacings wide. In a cell a map of one axis is a tile: the places
// on the lines in and next to the cell that belong to one sheet of the surface. Where two sheets of one axis
// pass through a cell, as at a thin rim, a plane between them tells which of two tiles a point belongs to.
// The projection of a point far from the surface may miss the sheet; then the heights of the tile are not its
// own. ReliefShares says what a point takes from the places around it, for those who choose heights.
#pragma once

#include <array>
#include <cstdint>
#include <string>
#include <vector>

#include "synthesis/relief/relief_places.h"

namespace astrolith {

inline constexpr int kReliefCell = 4;                    // spacings
inline constexpr int kReliefTileSide = kReliefCell + 3;  // places along a side of a tile
inline constexpr int kReliefTileSize = kReliefTileSide * kReliefTileSide;
// At most so many cells hold the places of one layer.
inline constexpr double kMostReliefCells = 0x1p24;
inline constexpr std::uint32_t kNoPlace = 0xffffffffu;

// Two tiles of one axis and cell. A point belongs to `upper` where w > at + slope_u u + slope_v v, in
// spacings from the corner of the cell.
struct ReliefSplit {
  float at, slope_u, slope_v;
  std::int32_t lower, upper;
};

// Where the heights of a tile are those of points: in full within farthest - 1 / inverse_fade of the plane
// w = at + slope_u u + slope_v v, along the axis, and nowhere from `farthest` on. In spacings from the corner
// of the cell.
struct ReliefSheet {
  float at, slope_u, slope_v;
  float farthest, inverse_fade;
};

struct ReliefTiles {
  std::array<std::int32_t, 3> low{}, count{};  // cells: the first one along each axis, and how many
  // (cells x 3) For each cell, x fastest, and axis: the number of the tile, or -1 - number of the split. Tile
  // 0 is empty.
  std::vector<std::int32_t> tiles;
  std::vector<ReliefSplit> splits;
  // (tiles x kReliefTileSize) The number of the place on each line of a tile, u fastest; kNoPlace without
  // one.
  std::vector<std::uint32_t> places;
  std::vector<ReliefSheet> sheets;  // (tiles)

  std::size_t num_tiles() const { return places.size() / kReliefTileSize; }
};

// A point in the tiles.
struct TiledPoint {
  std::int64_t cell;
  std::array<double, 3> at;           // in spacings from the corner of the cell
  std::array<std::int32_t, 3> tiles;  // of each axis

  // Its coordinates along the lines of an axis: u and v.
  double u(std::size_t axis) const { return at[(axis + 1) % 3]; }
  double v(std::size_t axis) const { return at[(axis + 2) % 3]; }
};
// Finds a point, in spacings. Returns whether it lies in a cell.
bool find_in_tiles(const ReliefTiles& tiles, const std::array<double, 3>& at, TiledPoint& point);

// Expects places in the order of find_relief_places(). Throws InputError, which begins with `where`, where
// the box of the places has more than kMostReliefCells.
ReliefTiles make_relief_tiles(const std::vector<ReliefPlace>& places, const std::string& where);

// A point of the lattice takes shares[k] of the height at places[k]. The shares sum to 1, as height_at()
// (relief_noise.h) blends heights on smooth ground; at folds it weighs maps by their reach, too.
class ReliefShares {
 public:
  // Expects places in the order of find_relief_places() and their tiles, which must outlive this, and their
  // spacing in length units.
  ReliefShares(const std::vector<ReliefPlace>& places, const ReliefTiles& tiles, double spacing)
      : places_(places), tiles_(tiles), inverse_spacing_(1.0 / spacing) {}

  // Appends what a point, in length units, takes. Appends nothing where no place has a weight.
  void add(const Vec3f& p, std::vector<std::uint32_t>& places, std::vector<float>& shares) const;

 private:
  double add_tile(std::size_t tile, double u, double v, std::vector<std::uint32_t>& places,
                  std::vector<float>& shares) const;

  const std::vector<ReliefPlace>& places_;
  const ReliefTiles& tiles_;
  double inverse_spacing_;
};

}  // namespace astrolith
