#include "synthesis/exemplar/tiled_gabor_noise.h"

#include <algorithm>
#include <cmath>
#include <memory>

#include "numerics/hash_random.h"
#include "synthesis/exemplar/exemplar_ground.h"
#include "synthesis/exemplar/phase_tile.h"
#include "synthesis/gabor/gabor_bands.h"

namespace astrolith {
namespace {

// The numbers of bands that stand for the tiles of a layer in hashes lie above those of all bandwidths.
constexpr int kFirstTileBand = 64;

// How anchors lay a tile on a surface.
ExemplarLayer tile_layer(const GaborLayer& layer, const PhaseTile& tile, double height_rms) {
  ExemplarLayer laid;
  laid.pixel_size = layer.pixel_size * tile.pixel;
  laid.height_rms = height_rms;
  laid.exponent = kPhaseTileExponent;
  laid.anchor_spacing = kPhaseTileSpacing;
  laid.pixels = std::make_shared<const ExemplarImage>(ExemplarImage{tile.side, tile.side, {}, {}});
  return laid;
}

PhaseTileSet::Tile make_phase_tile(const GaborLayer& layer, const PhaseTile& tile, double share,
                                   std::uint32_t seed, ArrayStore& arrays) {
  const double height_rms = layer.height_rms * std::sqrt(share);
  PhaseTileSet::Tile laid{tile_layer(layer, tile, height_rms), {}, seed, share};
  laid.made.texture =
      make_gaussian_texture(tile.side, random_phase_tile(tile, hash_append(seed, 1)), height_rms, arrays);
  laid.made.exponent = kPhaseTileExponent;
  laid.made.height_bound = laid.made.texture.greatest;
  laid.made.detail.finest = laid.layer.pixel_size;
  return laid;
}

// Joins the tiles of a layer, placed by placed_exemplar(), and the noise of its narrow lobes.
TiledGaborNoise join_phase_tiles(const GaborLayer& layer, const PhaseTileSet& set,
                                 const std::vector<ExemplarNoise>& placed, const GaborSurfaceNoise& narrow,
                                 ArrayStore& arrays) {
  TiledGaborNoise noise;
  noise.narrow = narrow;
  noise.clip = static_cast<float>(kGaborClip * layer.height_rms);
  noise.height_bound = static_cast<double>(noise.clip);
  noise.detail.finest = narrow.detail.finest;
  noise.detail.left_out = set.narrow_share * narrow.detail.left_out;
  for (std::size_t i = 0; i < placed.size(); ++i) {
    noise.detail.finest = std::min(noise.detail.finest, placed[i].detail.finest);
    noise.detail.left_out += set.tiles[i].share * placed[i].detail.left_out;
  }
  noise.tiles = arrays.add(placed);
  return noise;
}

void add_tiles(const TiledGaborNoise& noise, const BodyGround& ground, int n, const float* x, const float* y,
               const float* z, float* height) {
  std::vector<float> of_tile(static_cast<std::size_t>(n));
  for (const ExemplarNoise& tile : ground.arrays.span(noise.tiles)) {
    evaluate_heights(tile, ground.arrays, n, x, y, z, of_tile.data());
    for (int i = 0; i < n; ++i) height[i] += of_tile[static_cast<std::size_t>(i)];
  }
  for (int i = 0; i < n; ++i) height[i] = math::clamp(height[i], -noise.clip, noise.clip);
}

}  // namespace

PhaseTileSet prepare_tiles(const GaborLayer& layer, const LayerSource& source, ArrayStore& arrays) {
  const PhaseTilePlan plan = plan_phase_tiles(layer.lobes);
  double narrow = 0.0, total = 0.0;
  for (const GaborLobe& lobe : plan.narrow) narrow += lobe.variance;
  total = narrow;
  for (const PhaseTile& tile : plan.tiles) total += tile.variance();
  PhaseTileSet set;
  set.narrow = layer;
  set.narrow.lobes = plan.narrow;
  set.narrow_share = narrow / total;
  set.narrow.height_rms = layer.height_rms * std::sqrt(set.narrow_share);
  for (const PhaseTile& tile : plan.tiles) {
    const int number = static_cast<int>(set.tiles.size());
    set.tiles.push_back(
        make_phase_tile(layer, tile, tile.variance() / total,
                        gabor_band_seed(source.recipe.seed, source.number, kFirstTileBand + number), arrays));
  }
  return set;
}

TiledGaborNoise placed(const GaborLayer& layer, const PhaseTileSet& set, const LayerSource& source,
                       const LayerSite& site, ArrayStore& arrays) {
  std::vector<ExemplarNoise> tiles;
  for (const PhaseTileSet::Tile& tile : set.tiles) {
    tiles.push_back(placed_exemplar(tile.made, tile.layer, tile.seed, 0, site, false, arrays));
  }
  const GaborSurfaceNoise narrow =
      make_noise(set.narrow, source.recipe.seed, source.number, site.frame, site.body_side, arrays);
  return join_phase_tiles(layer, set, tiles, narrow, arrays);
}

void evaluate_heights(const TiledGaborNoise& noise, const BodyGround& ground, const GaborTileCache* caches,
                      int n, const float* x, const float* y, const float* z, float* height) {
  std::fill(height, height + n, 0.0f);
  if (noise.narrow.bands.count > 0) evaluate_heights(noise.narrow, ground, caches, n, x, y, z, height);
  add_tiles(noise, ground, n, x, y, z, height);
}

void evaluate_tetrahedron_heights(const TiledGaborNoise& noise, const BodyGround& ground,
                                  const GaborTileCache* caches, int n, const float* x, const float* y,
                                  const float* z, float* height) {
  std::fill(height, height + n, 0.0f);
  if (noise.narrow.bands.count > 0) {
    evaluate_tetrahedron_heights(noise.narrow, ground, caches, n, x, y, z, height);
  }
  add_tiles(noise, ground, n, x, y, z, height);
}

}  // namespace astrolith
