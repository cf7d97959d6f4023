#include "synthesis/relief/relief_noise.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <vector>

#include "numerics/errors.h"
#include "numerics/hash_random.h"
#include "synthesis/relief/relief_likeness.h"
#include "synthesis/relief/relief_picture.h"

namespace astrolith {
namespace {

// The codes of the places; throws InputError where the picture has others than these.
std::vector<std::uint16_t> codes_of(const ReliefLayer& layer, const std::vector<ReliefPlace>& places,
                                    const std::string& place) {
  if (layer.pixels == nullptr) throw InputError(place + ": the image of the relief has not been loaded");
  const ExemplarImage& image = *layer.pixels;
  const ReliefLayout layout = relief_layout(places);
  const auto used = static_cast<std::size_t>(
      std::count_if(image.values.begin(), image.values.end(), [](std::uint16_t v) { return v != 0; }));
  const bool same_size = image.width >= layout.width && image.height >= layout.height;
  std::vector<std::uint16_t> codes(places.size());
  bool same = same_size && used == places.size();
  for (std::size_t i = 0; same && i < places.size(); ++i) {
    const std::size_t row = layout.pixels[i] / static_cast<std::size_t>(layout.width),
                      column = layout.pixels[i] % static_cast<std::size_t>(layout.width);
    const std::uint16_t value = image.values[row * static_cast<std::size_t>(image.width) + column];
    same = value != 0;
    codes[i] = layer.code_of(value);
  }
  if (!same) {
    throw InputError(place +
                     ".image: is of other metaballs or another spacing than this recipe's; a relief belongs "
                     "to its body: take the recipe's "
                     "own image, or leave the layer out");
  }
  return codes;
}

std::vector<double> heights_of(const ReliefLayer& layer, const std::vector<std::uint16_t>& codes) {
  std::vector<double> heights(codes.size());
  for (std::size_t i = 0; i < codes.size(); ++i) heights[i] = layer.low + layer.step() * codes[i];
  return heights;
}

// The heights as codes of their own range, which the noise gets.
std::vector<std::uint16_t> encode(const std::vector<double>& heights, ReliefNoise& noise) {
  if (heights.empty()) return {};
  const auto [least, most] = std::minmax_element(heights.begin(), heights.end());
  noise.low = static_cast<float>(*least);
  noise.step = static_cast<float>((*most - *least) / 65535.0);
  std::vector<std::uint16_t> codes(heights.size());
  for (std::size_t i = 0; i < heights.size(); ++i) {
    const double code = noise.step > 0.0f ? (heights[i] - double{noise.low}) / double{noise.step} : 0.0;
    codes[i] = static_cast<std::uint16_t>(std::clamp(std::floor(code + 0.5), 0.0, 65535.0));
  }
  return codes;
}

// The heights of the layer, drawn for other places or another body.
std::vector<double> drawn_heights(const ReliefLayer& layer, const LayerSource& source,
                                  const BodyGround& ground, const std::vector<ReliefPlace>& places) {
  const LikenessOptions options{layer.edge_length(), layer.reach,
                                hash_seed(source.recipe.seed, static_cast<std::uint32_t>(source.number))};
  const auto like = [&](const BodyGround& of, const std::vector<ReliefPlace>& its_places) {
    const std::vector<double> heights = heights_of(layer, codes_of(layer, its_places, source.place));
    return like_heights(places, {of, its_places, heights}, layer.donor.has_value(), layer.spacing, options,
                        source.place);
  };
  if (!layer.donor) return like(ground, places);
  ArrayStore arrays;
  const BodyTables body = make_body(*layer.donor, source.recipe.seed, arrays);
  const ReachingMetaballs metaballs = all_metaballs(body, arrays.view());
  const BodyGround donor{body, arrays.view(), metaballs.lists()};
  return like(donor, find_relief_places(donor, layer.spacing, source.place));
}

// The bounds of the codes in each cell.
std::vector<ReliefCodeRange> ranges_of(const ReliefTiles& tiles, const std::vector<std::uint16_t>& codes) {
  std::vector<ReliefCodeRange> of_tile(tiles.num_tiles(), {0xffff, 0});
  for (std::size_t i = 0; i < tiles.places.size(); ++i) {
    if (tiles.places[i] == kNoPlace) continue;
    ReliefCodeRange& r = of_tile[i / kReliefTileSize];
    r.least = std::min(r.least, codes[tiles.places[i]]);
    r.greatest = std::max(r.greatest, codes[tiles.places[i]]);
  }
  std::vector<ReliefCodeRange> ranges(tiles.tiles.size() / 3, {0xffff, 0});
  for (std::size_t i = 0; i < tiles.tiles.size(); ++i) {
    const auto extend = [&](std::int32_t tile) {
      const ReliefCodeRange& r = of_tile[static_cast<std::size_t>(tile)];
      ranges[i / 3].least = std::min(ranges[i / 3].least, r.least);
      ranges[i / 3].greatest = std::max(ranges[i / 3].greatest, r.greatest);
    };
    const std::int32_t tile = tiles.tiles[i];
    if (tile >= 0) {
      extend(tile);
    } else {
      const ReliefSplit& split = tiles.splits[static_cast<std::size_t>(-1 - tile)];
      extend(split.lower), extend(split.upper);
    }
  }
  return ranges;
}

constexpr int kChunk = 256;  // points whose arrays stay in the first cache

// Writes the cells of points, and their coordinates from the corners of the cells.
ASTROLITH_SIMD_CLONES void find_cells(const ReliefNoise& of_layer, int n, const float* __restrict px,
                                      const float* __restrict py, const float* __restrict pz,
                                      std::int32_t* __restrict cell, float* __restrict x, float* __restrict y,
                                      float* __restrict z) {
  const ReliefNoise noise = of_layer;
#pragma omp simd
  for (int i = 0; i < n; ++i) {
    const ReliefPoint p = relief_point(noise, {px[i], py[i], pz[i]});
    cell[i] = p.cell, x[i] = p.x, y[i] = p.y, z[i] = p.z;
  }
}

// Adds the tiles of one axis, which begin at these words, to the sums of weights and codes.
ASTROLITH_SIMD_CLONES void add_tiles(const std::uint32_t* words, const std::int32_t* __restrict first, int n,
                                     const float* __restrict u, const float* __restrict v,
                                     float* __restrict weight, float* __restrict code) {
#pragma omp simd
  for (int i = 0; i < n; ++i) {
    ReliefSums sums{weight[i], code[i]};
    add_relief_tile(words + first[i], u[i], v[i], sums);
    weight[i] = sums.weight, code[i] = sums.code;
  }
}

ASTROLITH_SIMD_CLONES void finish_heights(const ReliefNoise& of_layer, int n, const float* __restrict weight,
                                          const float* __restrict code, float* __restrict height) {
  const ReliefNoise noise = of_layer;
#pragma omp simd
  for (int i = 0; i < n; ++i) height[i] = relief_height(noise, {weight[i], code[i]});
}

void evaluate_chunk(const ReliefNoise& n, const ArrayView& arrays, int count, const float* px,
                    const float* py, const float* pz, float* height) {
  std::array<float, kChunk> x, y, z, weight, code;
  std::array<std::int32_t, kChunk> cell, first;
  find_cells(n, count, px, py, pz, cell.data(), x.data(), y.data(), z.data());
  std::fill_n(weight.data(), count, 0.0f);
  std::fill_n(code.data(), count, 0.0f);
  const std::int32_t* tiles = arrays[n.tiles];
  const ReliefSplit* splits = arrays[n.splits];
  const std::array<const float*, 3> p{x.data(), y.data(), z.data()};
  for (std::size_t a = 0; a < 3; ++a) {
    const float *u = p[(a + 1) % 3], *v = p[(a + 2) % 3], *w = p[a];
    bool any = false;
    for (std::size_t i = 0; i < static_cast<std::size_t>(count); ++i) {
      first[i] =
          kReliefTileSize * relief_tile(tiles[3 * std::int64_t{cell[i]} + static_cast<std::int64_t>(a)],
                                        splits, u[i], v[i], w[i]);
      any |= first[i] != 0;
    }
    // The empty tile adds exactly nothing.
    if (any) add_tiles(arrays[n.words], first.data(), count, u, v, weight.data(), code.data());
  }
  finish_heights(n, count, weight.data(), code.data(), height);
}

}  // namespace

ReliefNoise prepare(const ReliefLayer& layer, const LayerSource&, ArrayStore&) {
  ReliefNoise noise;
  noise.inverse_spacing = static_cast<float>(1.0 / layer.spacing);
  noise.low = static_cast<float>(layer.low);
  noise.step = static_cast<float>(layer.step());
  noise.detail.finest = layer.spacing;
  return noise;
}

ReliefNoise placed(const ReliefLayer& layer, const ReliefNoise& prepared, const LayerSource& source,
                   const LayerSite& site, ArrayStore& arrays) {
  ReliefNoise noise = prepared;
  const std::vector<ReliefPlace> places = find_relief_places(site.ground(), layer.spacing, source.place);
  const std::vector<std::uint16_t> codes =
      layer.arrangement == ReliefArrangement::kLike
          ? encode(drawn_heights(layer, source, site.ground(), places), noise)
          : codes_of(layer, places, source.place);
  const ReliefTiles tiles = make_relief_tiles(places, source.place);
  std::vector<std::uint32_t> words(tiles.places.size(), 0);
  for (std::size_t i = 0; i < words.size(); ++i) {
    const std::uint32_t number = tiles.places[i];
    if (number != kNoPlace) words[i] = std::uint32_t{places[number].weight} << 16 | codes[number];
  }
  noise.count_x = tiles.count[0], noise.count_y = tiles.count[1], noise.count_z = tiles.count[2];
  const Vec3d origin = site.frame.origin * (1.0 / layer.spacing);
  noise.origin = to_float(origin - Vec3d{static_cast<double>(tiles.low[0]), static_cast<double>(tiles.low[1]),
                                         static_cast<double>(tiles.low[2])} *
                                       static_cast<double>(kReliefCell));
  const std::vector<ReliefCodeRange> ranges = ranges_of(tiles, codes);
  noise.tiles = arrays.add(tiles.tiles);
  noise.splits = arrays.add(tiles.splits);
  noise.words = arrays.add(words);
  noise.ranges = arrays.add(ranges);
  for (const std::uint16_t code : codes) {
    noise.height_bound =
        std::max(noise.height_bound, std::fabs(double{noise.low} + double{noise.step} * code));
  }
  noise.height_bound *= 1.0 + 1e-5;
  return noise;
}

void evaluate_heights(const ReliefNoise& n, const ArrayView& arrays, int count, const float* x,
                      const float* y, const float* z, float* height) {
  if (n.count_x == 0) {
    std::fill_n(height, count, 0.0f);
    return;
  }
  for (int i = 0; i < count; i += kChunk) {
    evaluate_chunk(n, arrays, std::min(kChunk, count - i), x + i, y + i, z + i, height + i);
  }
}

}  // namespace astrolith
