// The wide lobes of a Gabor layer as random-phase tiles: periodic Gaussian textures whose power spectra are
// those of the lobes. The anchors of an exemplar layer lay them on a surface.
//
// With c the spacing of the anchors in pixels and a the bandwidth of a lobe's kernel in cycles per pixel, a
// lobe is wide where a c >= kLeastTileWidth. Blending multiplies the covariance of a tile by the correlation
// of the blending weights, which blurs the spectrum by kPhaseTileBlur / c. The lobes of a tile are narrower
// by that, so that they have their own widths on the surface.
#pragma once

#include <cstdint>
#include <vector>

#include "recipe/noise_layers.h"

namespace astrolith {

inline constexpr double kLeastTileWidth = 8.0;
inline constexpr int kLeastPhaseTile = 128, kMostPhaseTile = 1024;  // sides of a tile, in its own pixels
inline constexpr int kMostPhaseTiles = 3;                           // tiles of a layer
inline constexpr double kPhaseTileSpacing = 0.5;                    // of the anchors, in sides of a tile
inline constexpr int kPhaseTileExponent = 2;                        // of the blending weights
// The standard deviation of the Gaussian nearest to the blur of the spectrum, in 1 / c: the correlation of
// the weights at the distance c / 5 is exp(-2 (pi kPhaseTileBlur / 5)^2).
inline constexpr double kPhaseTileBlur = 0.354;

// Wide lobes that share a tile.
struct PhaseTile {
  int side = kMostPhaseTile;  // pixels of the tile, a power of two
  double pixel = 1.0;         // side of a pixel of the tile, in pixels of the layer
  std::vector<GaborLobe> lobes;

  double variance() const;  // sum over the lobes
  // The spacing of the anchors, in pixels of the layer.
  double spacing() const { return kPhaseTileSpacing * side * pixel; }
};

struct PhaseTilePlan {
  std::vector<PhaseTile> tiles;   // at most kMostPhaseTiles
  std::vector<GaborLobe> narrow;  // the lobes that no tile holds; they stay impulses
};

// Shares lobes out among as few tiles as possible. The pixels of a tile are so fine that its lobes lie below
// 0.3 cycles per pixel of the tile up to two deviations, and so coarse that all of them are wide.
PhaseTilePlan plan_phase_tiles(const std::vector<GaborLobe>& lobes);

// The power of a tile's cosines, side x side, row-major along x; total 1. There is no power at frequency 0:
// its four neighbours have it instead.
std::vector<double> tile_power(const PhaseTile& tile);

// The coefficients of the quadratic B-spline of a tile with random phases, side x side, row-major.
std::vector<double> random_phase_tile(const PhaseTile& tile, std::uint32_t seed);

}  // namespace astrolith
