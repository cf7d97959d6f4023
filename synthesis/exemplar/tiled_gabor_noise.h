// A Gabor layer on the surface of a body whose wide lobes are random-phase tiles (phase_tile.h). Anchors lay
// the tiles as they lay the image of an exemplar layer. Narrow lobes are impulses (gabor_surface_noise.h).
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "numerics/arrays.h"
#include "numerics/interval.h"
#include "synthesis/exemplar/exemplar_noise.h"
#include "synthesis/gabor/gabor_surface_noise.h"
#include "synthesis/noise/noise_traits.h"

namespace astrolith {

struct TiledGaborNoise {
  static constexpr NoiseTraits kTraits{.on_surface = true,
                                       .lifts = false,
                                       .has_heights = true,
                                       .bounded_by_box = false,
                                       .local_form = false,
                                       .lists = NoiseLists::kGabor};

  GaborSurfaceNoise narrow;  // without bands where all lobes are wide
  ArrayRange<ExemplarNoise> tiles;
  float clip = 0.0f;          // heights are clamped to +- clip: 6 standard deviations, length units
  double height_bound = 0.0;  // bound of |n(p)|, length units
  NoiseDetail detail;
};

ASTROLITH_HD inline const GaborSurfaceNoise& gabor_impulses(const TiledGaborNoise& noise) {
  return noise.narrow;
}

// A Gabor layer, taken apart.
struct PhaseTileSet {
  struct Tile {
    ExemplarLayer layer;  // how anchors lay the tile; its image has sides, but no values
    ExemplarNoise made;   // without anchors
    std::uint64_t seed;   // of the anchors, as placed_exemplar() takes it
    double share;         // of the layer's variance
  };
  std::vector<Tile> tiles;
  GaborLayer narrow;  // the narrow lobes with their own height_rms; maybe without lobes
  double narrow_share = 0.0;
};

// Makes the tiles of a layer, which are the same at every site.
PhaseTileSet prepare_tiles(const GaborLayer& layer, const LayerSource& source, ArrayStore& arrays);

// The tiles with the anchors of a site, and the impulses of the narrow lobes. The heights have mean 0 and the
// standard deviation layer.height_rms where no part is left out.
TiledGaborNoise placed(const GaborLayer& layer, const PhaseTileSet& set, const LayerSource& source,
                       const LayerSite& site, ArrayStore& arrays);

// The height of all tiles at a point of the bare surface, added to `height`, length units.
ASTROLITH_HD inline float with_phase_tiles(const TiledGaborNoise& n, const ArrayView& arrays, const Vec3f& at,
                                           float height) {
  const ExemplarNoise* tiles = arrays[n.tiles];
  for (std::uint32_t t = 0; t < n.tiles.count; ++t) height += height_at(tiles[t], arrays, at);
  return math::clamp(height, -n.clip, n.clip);
}

// The height at a point of the bare surface, length units, from the lists of impulses of the narrow lobes.
ASTROLITH_HD inline float height_at(const TiledGaborNoise& n, const ArrayView& arrays,
                                    const GaborImpulse* impulses, const std::uint32_t* first,
                                    const Vec3f& at) {
  const float height = n.narrow.bands.count == 0 ? 0.0f : height_at(n.narrow, arrays, impulses, first, at);
  return with_phase_tiles(n, arrays, at, height);
}

// The heights at the four corners p of a small tetrahedron, length units. Impulses are taken to first order
// about the centre.
ASTROLITH_HD inline void tetrahedron_heights(const TiledGaborNoise& n, const ArrayView& arrays,
                                             const GaborImpulse* impulses, const std::uint32_t* first,
                                             const Vec3f* p, float* heights) {
  for (int k = 0; k < 4; ++k) heights[k] = 0.0f;
  if (n.narrow.bands.count > 0) tetrahedron_heights(n.narrow, arrays, impulses, first, p, heights);
  for (int k = 0; k < 4; ++k) heights[k] = with_phase_tiles(n, arrays, p[k], heights[k]);
}

// Writes height[i] = n(p_i) at points of the bare surface, with the bits of height_at. `caches` has one
// element for each band of the narrow lobes.
void evaluate_heights(const TiledGaborNoise& noise, const BodyGround& ground, const GaborTileCache* caches,
                      int n, const float* x, const float* y, const float* z, float* height);

// Writes the heights at the corners of small tetrahedra, with the bits of tetrahedron_heights. Points 4 t to
// 4 t + 3 are the corners of tetrahedron t.
void evaluate_tetrahedron_heights(const TiledGaborNoise& noise, const BodyGround& ground,
                                  const GaborTileCache* caches, int n, const float* x, const float* y,
                                  const float* z, float* height);

// An interval that holds n(p) for every point, length units. It does not depend on the box.
ASTROLITH_HD inline Interval bound_heights(const TiledGaborNoise& n, const ArrayView&, const Box&) {
  return {-n.height_bound, n.height_bound};
}

}  // namespace astrolith
