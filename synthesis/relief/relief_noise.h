// A relief layer of the recipe as plain tables: its height at one point of the bare surface, and over many
// points at once. The equation stands at ReliefLayer (recipe/relief_layer.h). Heights belong to the
// surface: where the projection of a point misses it, a map counts only near its sheet, and beside all sheets
// the height falls to 0.
#pragma once

#include <cstdint>
#include <memory>

#include "numerics/arrays.h"
#include "numerics/host_device.h"
#include "numerics/scalar_math.h"
#include "recipe/relief_layer.h"
#include "synthesis/body/layer_site.h"
#include "synthesis/noise/noise_frame.h"
#include "synthesis/noise/noise_traits.h"
#include "synthesis/relief/relief_levels.h"
#include "synthesis/relief/relief_tiles.h"

namespace astrolith {

// The least and the greatest code of the tiles of a cell; least > greatest where it has none.
struct ReliefCodeRange {
  std::uint16_t least, greatest;
};

struct ReliefNoise {
  static constexpr NoiseTraits kTraits{.on_surface = true,
                                       .lifts = false,
                                       .has_heights = true,
                                       .bounded_by_box = true,
                                       .local_form = false,
                                       .lists = NoiseLists::kNone};

  float inverse_spacing = 1.0f;  // 1 / length units
  Vec3f origin;                  // of the points' frame, in spacings from the corner of the first cell
  std::int32_t count_x = 0, count_y = 0, count_z = 0;  // cells
  float low = 0.0f, step = 0.0f;   // the height of code 0, and of a code above the one before; length units
  ArrayRange<std::int32_t> tiles;  // (cells x 3) ReliefTiles::tiles
  ArrayRange<ReliefSplit> splits;
  ArrayRange<ReliefSheet> sheets;      // (tiles)
  ArrayRange<std::uint32_t> words;     // (tiles x kReliefTileSize) weight << 16 | code
  ArrayRange<ReliefCodeRange> ranges;  // (cells)
  ReliefLevels below;                  // below the edges of the model
  double height_bound = 0.0;           // bound of |n(p)|, length units
  NoiseDetail detail;
};

// The heights of a layer at the places of its body, found when the first site asks.
struct ReliefGround;

// What all sites of a layer share.
struct PreparedRelief {
  ReliefNoise noise;
  std::shared_ptr<ReliefGround> ground;
};
PreparedRelief prepare(const ReliefLayer& layer, const LayerSource& source, ArrayStore& arrays);

// The layer with the heights that it draws or fills as its own: measured ones, of this body. Meshes keep
// their bytes, but for levels below the model, which are then made of these heights. Throws as placed() does.
ReliefLayer with_own_heights(const ReliefLayer& layer, const LayerSource& source, const BodyGround& body);

// The rms of the layer's heights over their means with this standard deviation, both in length units.
double relief_roughness(const ReliefLayer& layer, const LayerSource& source, const BodyGround& body,
                        double deviation);

// The noise at a site. Throws InputError, which begins with the source's place, where the layer has no
// pixels, or where they are not those of the places on this body.
ReliefNoise placed(const ReliefLayer& layer, const PreparedRelief& prepared, const LayerSource& source,
                   const LayerSite& site, ArrayStore& arrays);

// The weights of the four places next to a point, which lies t in [0, 1] beyond the second: a cubic B-spline.
struct CubicWeights {
  float w0, w1, w2, w3;
};
ASTROLITH_KERNEL CubicWeights cubic_weights(float t) {
  constexpr float kSixth = 1.0f / 6.0f;
  const float s = 1.0f - t, t2 = t * t, s2 = s * s;
  return {kSixth * s2 * s, math::fma(0.5f * t - 1.0f, t2, 2.0f / 3.0f),
          math::fma(0.5f * s - 1.0f, s2, 2.0f / 3.0f), kSixth * t2 * t};
}

// The sums over the places of the tiles around a point: of weights, and of weights times codes. Near its
// sheet a tile counts in full, far from it not at all.
struct ReliefSums {
  float weight = 0.0f, code = 0.0f;
};

// 1 near a sheet, 0 far from it. `off` is the distance from its plane along its axis, in spacings.
ASTROLITH_KERNEL float sheet_reach(const ReliefSheet& s, float u, float v, float w) {
  const float off = w - math::fma(s.slope_u, u, math::fma(s.slope_v, v, s.at));
  return math::clamp((s.farthest - math::abs(off)) * s.inverse_fade, 0.0f, 1.0f);
}

// The places of a tile around a point: four rows of four words, each kReliefTileSide after the one before.
// The point lies (u, v) in [0, 1] beyond the second word of the second row.
struct ReliefFootprint {
  std::int32_t first;  // number of the first word
  float u, v;
};

// The footprint of the point (u, v) in [0, kReliefCell], in spacings from the corner of its cell, on the tile
// that begins at word number `tile`.
ASTROLITH_KERNEL ReliefFootprint relief_footprint(std::int32_t tile, float u, float v) {
  constexpr float kLast = static_cast<float>(kReliefCell - 1);
  const float iu = math::clamp(math::floor(u), 0.0f, kLast), iv = math::clamp(math::floor(v), 0.0f, kLast);
  return {tile + static_cast<std::int32_t>(iv) * kReliefTileSide + static_cast<std::int32_t>(iu), u - iu,
          v - iv};
}

ASTROLITH_KERNEL void add_relief_row(const std::uint32_t* row, const CubicWeights& u, float v,
                                     ReliefSums& sums) {
  const auto add = [&](std::uint32_t word, float by) {
    const float weight = by * static_cast<float>(static_cast<std::int32_t>(word >> 16));
    sums.weight += weight;
    sums.code = math::fma(weight, static_cast<float>(static_cast<std::int32_t>(word & 0xffffu)), sums.code);
  };
  add(row[0], u.w0 * v);
  add(row[1], u.w1 * v);
  add(row[2], u.w2 * v);
  add(row[3], u.w3 * v);
}

// Adds the words of a footprint, of which `first` is the first, to the sums, as words of a tile of this
// reach.
ASTROLITH_KERNEL void add_relief_words(const std::uint32_t* first, float u, float v, float reach,
                                       ReliefSums& sums) {
  const CubicWeights wu = cubic_weights(u), wv = cubic_weights(v);
  ReliefSums tile;
  add_relief_row(first, wu, wv.w0, tile);
  add_relief_row(first + kReliefTileSide, wu, wv.w1, tile);
  add_relief_row(first + 2 * kReliefTileSide, wu, wv.w2, tile);
  add_relief_row(first + 3 * kReliefTileSide, wu, wv.w3, tile);
  sums.weight = math::fma(reach, tile.weight, sums.weight);
  sums.code = math::fma(reach, tile.code, sums.code);
}

// A point in the lattice: its cell, and its place there in spacings from the corner of the cell.
struct ReliefPoint {
  std::int32_t cell;
  float x, y, z;
};
ASTROLITH_KERNEL ReliefPoint relief_point(const ReliefNoise& n, const Vec3f& p) {
  constexpr float kInverse = 1.0f / static_cast<float>(kReliefCell), kCell = static_cast<float>(kReliefCell);
  const auto along = [&](float coordinate, float origin, std::int32_t count) {
    const float most = static_cast<float>(count) * kCell;
    return math::clamp(math::fma(coordinate, n.inverse_spacing, origin), 0.0f, most);
  };
  const auto cell = [&](float at, std::int32_t count) {
    return math::min(math::floor(at * kInverse), static_cast<float>(count - 1));
  };
  const float x = along(p.x, n.origin.x, n.count_x), y = along(p.y, n.origin.y, n.count_y),
              z = along(p.z, n.origin.z, n.count_z);
  const float cx = cell(x, n.count_x), cy = cell(y, n.count_y), cz = cell(z, n.count_z);
  const std::int32_t number =
      static_cast<std::int32_t>(cx) +
      n.count_x * (static_cast<std::int32_t>(cy) + n.count_y * static_cast<std::int32_t>(cz));
  return {number, math::fma(-kCell, cx, x), math::fma(-kCell, cy, y), math::fma(-kCell, cz, z)};
}

// The number of the tile of an axis for a point with the coordinates (u, v, w) along it.
ASTROLITH_HD inline std::int32_t relief_tile(std::int32_t tile, const ReliefSplit* splits, float u, float v,
                                             float w) {
  if (tile >= 0) return tile;
  const ReliefSplit& s = splits[-1 - tile];
  return w > math::fma(s.slope_u, u, math::fma(s.slope_v, v, s.at)) ? s.upper : s.lower;
}

// Around a point of a smooth surface the weights sum to 65535 (1/3 - 1/5)^2 / (4/5)^2 * 3 = 5461 at least.
// Where they sum to less than this, the point is beside the surface that the places show.
inline constexpr float kLeastReliefWeight = 4096.0f;

// The mean of low + step * code with these sums. It falls to 0 beside the surface.
ASTROLITH_KERNEL float relief_mean(float low, float step, const ReliefSums& sums) {
  return math::fma(step, sums.code, low * sums.weight) / math::max(sums.weight, kLeastReliefWeight);
}

// The sums of these words around a point of the lattice.
ASTROLITH_HD inline ReliefSums sums_in_lattice(const ReliefNoise& n, const std::uint32_t* words,
                                               const ArrayView& arrays, const ReliefPoint& p) {
  const std::int32_t* tiles = arrays[n.tiles] + 3 * std::int64_t{p.cell};
  const ReliefSplit* splits = arrays[n.splits];
  const ReliefSheet* sheets = arrays[n.sheets];
  ReliefSums sums;
  const auto add = [&](std::int32_t axis_tile, float u, float v, float w) {
    const std::int32_t tile = relief_tile(axis_tile, splits, u, v, w);
    const ReliefFootprint f = relief_footprint(kReliefTileSize * tile, u, v);
    add_relief_words(words + f.first, f.u, f.v, sheet_reach(sheets[tile], u, v, w), sums);
  };
  add(tiles[0], p.y, p.z, p.x);
  add(tiles[1], p.z, p.x, p.y);
  add(tiles[2], p.x, p.y, p.z);
  return sums;
}

// The height of the model's own relief at a point of the lattice, length units.
ASTROLITH_HD inline float height_in_lattice(const ReliefNoise& n, const ArrayView& arrays,
                                            const ReliefPoint& p) {
  return relief_mean(n.low, n.step, sums_in_lattice(n, arrays[n.words], arrays, p));
}

// The height at a point of the bare surface, length units.
ASTROLITH_HD inline float height_at(const ReliefNoise& n, const ArrayView& arrays, const Vec3f& at) {
  if (n.count_x == 0) return 0.0f;
  const ReliefPoint p = relief_point(n, at);
  const float height = height_in_lattice(n, arrays, p);
  if (n.below.levels.count == 0) return height;
  const float roughness =
      relief_mean(0.0f, n.below.step, sums_in_lattice(n, arrays[n.below.words], arrays, p));
  return math::fma(roughness, level_sum(n.below, arrays, at), height);
}

// Writes height[i] = n(p_i) at these points, length units. The loops are vectorised and give the same bits as
// height_at.
void evaluate_heights(const ReliefNoise& n, const ArrayView& arrays, int count, const float* x,
                      const float* y, const float* z, float* height);

}  // namespace astrolith
