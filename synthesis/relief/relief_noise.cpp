#include "synthesis/relief/relief_noise.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <mutex>
#include <vector>

#include "numerics/errors.h"
#include "numerics/hash_random.h"
#include "synthesis/relief/relief_level_ground.h"
#include "synthesis/relief/relief_likeness.h"
#include "synthesis/relief/relief_picture.h"
#include "synthesis/relief/relief_values.h"

namespace astrolith {
namespace {

// The codes of the places; throws InputError where the picture has others than these.
std::vector<std::uint16_t> read_codes(const ReliefLayer& layer, const std::vector<ReliefPlace>& places,
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
    codes[i] = layer.grey_to_code(value);
  }
  if (!same) {
    throw InputError(place +
                     ".image: is of other metaballs or another spacing than this recipe's; a relief belongs "
                     "to its body: take the recipe's "
                     "own image, or leave the layer out");
  }
  return codes;
}

std::vector<double> decode_heights(const ReliefLayer& layer, const std::vector<std::uint16_t>& codes) {
  std::vector<double> heights(codes.size());
  for (std::size_t i = 0; i < codes.size(); ++i) heights[i] = layer.low + layer.step() * codes[i];
  return heights;
}

// The metaballs of a donor, and its places.
struct DonorBody {
  ArrayStore arrays;
  BodyTables body;
  ReachingMetaballs metaballs;
  std::vector<ReliefPlace> places;
  ReliefTiles tiles;

  DonorBody(const MetaballBody& donor, double spacing, const LayerSource& source)
      : body(make_body(donor, source.recipe.seed, arrays)),
        metaballs(all_metaballs(body, arrays.view())),
        places(find_relief_places(ground(), spacing, source.place)),
        tiles(make_relief_tiles(places, source.place)) {}
  BodyGround ground() const { return {body, arrays.view(), metaballs.lists()}; }
};

// The spacing of the lattice over the recipe's body, length units.
double lattice_spacing(const ReliefLayer& layer) { return layer.donor_scale * layer.spacing; }

std::uint32_t source_hash(const LayerSource& source) {
  return hash_seed(source.recipe.seed, static_cast<std::uint32_t>(source.number));
}

}  // namespace

struct ReliefGround {
  std::once_flag once;
  std::vector<ReliefPlace> places;
  std::vector<std::uint16_t> codes;
  float low = 0.0f, step = 0.0f;  // length units
  ReliefTiles tiles;
  LevelGround levels;

  void find(const ReliefLayer& layer, const LayerSource& source, const BodyGround& body);
};

namespace {

// The heights as codes of their own range, a quarter of the layer's step apart where their range allows it.
void encode(const ReliefLayer& layer, const std::vector<double>& heights, ReliefGround& ground) {
  constexpr double kMostCode = 65534.0, kFiner = 0.25;
  ground.codes.resize(heights.size());
  if (heights.empty()) return;
  const double scale = layer.donor_scale;  // heights are in the unit of the donor
  const auto [least, most] = std::minmax_element(heights.begin(), heights.end());
  ground.low = static_cast<float>(scale * *least);
  ground.step = static_cast<float>(scale * std::max((*most - *least) / kMostCode, kFiner * layer.step()));
  for (std::size_t i = 0; i < heights.size(); ++i) {
    const double code =
        ground.step > 0.0f ? (scale * heights[i] - double{ground.low}) / double{ground.step} : 0.0;
    ground.codes[i] = static_cast<std::uint16_t>(std::clamp(std::floor(code + 0.5), 0.0, kMostCode));
  }
}

// Heights of the layer drawn for other places of `body` or for another body, and what the levels below the
// model are made of.
void draw(const ReliefLayer& layer, const LayerSource& source, const BodyGround& body,
          const MeasuredRelief& measured, ReliefGround& ground) {
  const ReliefPatches patches(measured, layer.spacing, layer.edge_length());
  std::vector<double> heights = measured.heights;
  const double scale = layer.donor_scale;  // heights are in the unit of the donor
  const LikenessOptions options{layer.reach, layer.fill_unseen, source_hash(source),
                                layer.arrangement == ReliefArrangement::kLike};
  if (layer.arrangement != ReliefArrangement::kMeasured) {
    heights = like_heights(ground.places, ground.tiles, patches, layer.donor.has_value(), layer.spacing,
                           options, source.place);
    const std::vector<double> own = layer.donor ? std::vector(heights.size(), 0.0) : measured.heights;
    if (layer.donor)
      keep_room(body, ReliefPoints(ground.places, lattice_spacing(layer)), scale, own, heights);
    else
      keep_room(body, patches.points(), scale, own, heights);
    encode(layer, heights, ground);
  } else if (layer.fill_unseen) {
    heights = filled_heights(patches, layer.spacing, options);
    encode(layer, heights, ground);
  }
  if (layer.finer == 0) return;
  const ReliefPoints points(ground.places, layer.spacing);
  ground.levels = level_ground(patches, points, heights, hash_append(source_hash(source), 4));
  ground.levels.texture.pixel_size *= scale;
  ground.levels.step *= static_cast<float>(scale);
}

// The bounds of the codes in each cell.
std::vector<ReliefCodeRange> cell_code_ranges(const ReliefTiles& tiles,
                                              const std::vector<std::uint16_t>& codes) {
  std::vector<ReliefCodeRange> tile_ranges(tiles.num_tiles(), {0xffff, 0});
  for (std::size_t i = 0; i < tiles.places.size(); ++i) {
    if (tiles.places[i] == kNoPlace) continue;
    ReliefCodeRange& r = tile_ranges[i / kReliefTileSize];
    r.least = std::min(r.least, codes[tiles.places[i]]);
    r.greatest = std::max(r.greatest, codes[tiles.places[i]]);
  }
  std::vector<ReliefCodeRange> ranges(tiles.tiles.size() / 3, {0xffff, 0});
  for (std::size_t i = 0; i < tiles.tiles.size(); ++i) {
    const auto extend = [&](std::int32_t tile) {
      const ReliefCodeRange& r = tile_ranges[static_cast<std::size_t>(tile)];
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
ASTROLITH_SIMD_CLONES void find_cells(const ReliefNoise& shared_noise, int n, const float* __restrict px,
                                      const float* __restrict py, const float* __restrict pz,
                                      std::int32_t* __restrict cell, float* __restrict x, float* __restrict y,
                                      float* __restrict z) {
  const ReliefNoise noise = shared_noise;
#pragma omp simd
  for (int i = 0; i < n; ++i) {
    const ReliefPoint p = relief_point(noise, {px[i], py[i], pz[i]});
    cell[i] = p.cell, x[i] = p.x, y[i] = p.y, z[i] = p.z;
  }
}

// Makes numbers of tiles the first words of the footprints of points, and the points' places those in them.
ASTROLITH_SIMD_CLONES void find_footprints(int n, std::int32_t* __restrict first, float* __restrict u,
                                           float* __restrict v) {
#pragma omp simd
  for (int i = 0; i < n; ++i) {
    const ReliefFootprint f = relief_footprint(kReliefTileSize * first[i], u[i], v[i]);
    first[i] = f.first, u[i] = f.u, v[i] = f.v;
  }
}

// Adds the footprints of one axis to the sums of weights and codes. Neighbouring points mostly share a
// footprint, whose words are read once for all of them; four at a time, as many as a normal takes.
ASTROLITH_SIMD_CLONES void add_footprints(const std::uint32_t* words, const std::int32_t* __restrict first,
                                          int n, const float* __restrict u, const float* __restrict v,
                                          const float* __restrict reach, float* __restrict weight,
                                          float* __restrict code) {
  for (int begin = 0, end = 0; begin < n; begin = end) {
    while (end < n && first[end] == first[begin]) ++end;
    if (first[begin] < kReliefTileSize) continue;  // the empty tile adds exactly nothing
    const std::uint32_t* all_words = words + first[begin];
#pragma omp simd simdlen(4)
    for (int i = begin; i < end; ++i) {
      ReliefSums sums{weight[i], code[i]};
      add_relief_words(all_words, u[i], v[i], reach[i], sums);
      weight[i] = sums.weight, code[i] = sums.code;
    }
  }
}

// Writes the reaches of the sheets of these tiles.
ASTROLITH_SIMD_CLONES void find_reaches(const ReliefSheet* sheets, const std::int32_t* __restrict tile, int n,
                                        const float* __restrict u, const float* __restrict v,
                                        const float* __restrict w, float* __restrict reach) {
#pragma omp simd
  for (int i = 0; i < n; ++i) reach[i] = sheet_reach(sheets[tile[i]], u[i], v[i], w[i]);
}

ASTROLITH_SIMD_CLONES void find_means(float low, float step, int n, const float* __restrict weight,
                                      const float* __restrict code, float* __restrict mean) {
#pragma omp simd
  for (int i = 0; i < n; ++i) mean[i] = relief_mean(low, step, {weight[i], code[i]});
}

// The footprints of points on their tiles of each axis, and the reaches of these tiles' sheets.
struct ChunkPlaces {
  int count;
  std::array<std::array<float, kChunk>, 3> u, v;
  std::array<std::array<std::int32_t, kChunk>, 3> first;
  std::array<std::array<float, kChunk>, 3> reach;
  std::array<bool, 3> any{};  // whether a tile of the axis is not the empty one, which adds exactly nothing

  ChunkPlaces(const ReliefNoise& n, const ArrayView& arrays, int points, const float* px, const float* py,
              const float* pz)
      : count(points) {
    std::array<std::int32_t, kChunk> cell;
    std::array<std::array<float, kChunk>, 3> at;
    find_cells(n, count, px, py, pz, cell.data(), at[0].data(), at[1].data(), at[2].data());
    const std::int32_t* tiles = arrays[n.tiles];
    const ReliefSplit* splits = arrays[n.splits];
    for (std::size_t a = 0; a < 3; ++a) {
      u[a] = at[(a + 1) % 3], v[a] = at[(a + 2) % 3];
      for (std::size_t i = 0; i < static_cast<std::size_t>(count); ++i) {
        const std::int32_t axis_tile = tiles[3 * std::int64_t{cell[i]} + static_cast<std::int64_t>(a)];
        first[a][i] = relief_tile(axis_tile, splits, u[a][i], v[a][i], at[a][i]);
        any[a] |= first[a][i] != 0;
      }
      if (!any[a]) continue;
      find_reaches(arrays[n.sheets], first[a].data(), count, u[a].data(), v[a].data(), at[a].data(),
                   reach[a].data());
      find_footprints(count, first[a].data(), u[a].data(), v[a].data());
    }
  }

  // The means of low + step * code of these words.
  void means(const std::uint32_t* words, float low, float step, float* mean) const {
    std::array<float, kChunk> weight, code;
    std::fill_n(weight.data(), count, 0.0f);
    std::fill_n(code.data(), count, 0.0f);
    for (std::size_t a = 0; a < 3; ++a) {
      if (!any[a]) continue;
      add_footprints(words, first[a].data(), count, u[a].data(), v[a].data(), reach[a].data(), weight.data(),
                     code.data());
    }
    find_means(low, step, count, weight.data(), code.data(), mean);
  }
};

// The words of the tiles for a code of each place.
std::vector<std::uint32_t> pack_words(const ReliefGround& ground, const std::vector<std::uint16_t>& codes) {
  std::vector<std::uint32_t> words(ground.tiles.places.size(), 0);
  for (std::size_t i = 0; i < words.size(); ++i) {
    const std::uint32_t number = ground.tiles.places[i];
    if (number != kNoPlace) words[i] = std::uint32_t{ground.places[number].weight} << 16 | codes[number];
  }
  return words;
}

}  // namespace

void ReliefGround::find(const ReliefLayer& layer, const LayerSource& source, const BodyGround& body) {
  places = find_relief_places(body, lattice_spacing(layer), source.place);
  tiles = make_relief_tiles(places, source.place);
  low = static_cast<float>(layer.low);
  step = static_cast<float>(layer.step());
  if (layer.donor) {
    const DonorBody donor(*layer.donor, layer.spacing, source);
    const std::vector<double> heights = decode_heights(layer, read_codes(layer, donor.places, source.place));
    return draw(layer, source, body, {donor.ground(), donor.places, donor.tiles, heights}, *this);
  }
  codes = read_codes(layer, places, source.place);
  if (layer.arrangement == ReliefArrangement::kMeasured && layer.finer == 0 && !layer.fill_unseen) return;
  const std::vector<double> heights = decode_heights(layer, codes);
  draw(layer, source, body, {body, places, tiles, heights}, *this);
}

ReliefLayer with_own_heights(const ReliefLayer& layer, const LayerSource& source, const BodyGround& body) {
  ReliefGround ground;
  ground.find(layer, source, body);
  ReliefLayer own = layer;
  own.arrangement = ReliefArrangement::kMeasured;
  own.fill_unseen = false;
  own.donor.reset();
  own.rescale(layer.donor_scale);
  own.donor_scale = 1.0;
  const auto greatest = std::max_element(ground.codes.begin(), ground.codes.end());
  own.levels = greatest == ground.codes.end() ? 2 : std::max(2, *greatest + 1);
  own.low = double{ground.low};
  own.high = own.low + double{ground.step} * (own.levels - 1);
  own.image.clear(), own.image_sha256.clear();
  own.pixels = relief_image(own, ground.places, ground.codes, source.place);
  return own;
}

double relief_roughness(const ReliefLayer& layer, const LayerSource& source, const BodyGround& body,
                        double deviation) {
  ReliefGround ground;
  ground.find(layer, source, body);
  const ReliefPoints points(ground.places, lattice_spacing(layer));
  std::vector<double> heights;
  for (const std::uint16_t code : ground.codes)
    heights.push_back(double{ground.low} + double{ground.step} * code);
  const std::vector<double> means = smoothed_heights(points, heights, deviation);
  double squares = 0.0, weights = 0.0;
  for (std::size_t i = 0; i < heights.size(); ++i) {
    const double narrow = heights[i] - means[i];
    squares += points.weight(i) * narrow * narrow;
    weights += points.weight(i);
  }
  return weights > 0.0 ? std::sqrt(squares / weights) : 0.0;
}

PreparedRelief prepare(const ReliefLayer& layer, const LayerSource& source, ArrayStore&) {
  PreparedRelief prepared{{}, std::make_shared<ReliefGround>()};
  if (source.shared != nullptr) {
    std::shared_ptr<void>& held = (*source.shared)[source.place];
    if (held == nullptr) held = prepared.ground;
    prepared.ground = std::static_pointer_cast<ReliefGround>(held);
  }
  prepared.noise.inverse_spacing = static_cast<float>(1.0 / lattice_spacing(layer));
  prepared.noise.detail.finest = lattice_spacing(layer);
  return prepared;
}

ReliefNoise placed(const ReliefLayer& layer, const PreparedRelief& prepared, const LayerSource& source,
                   const LayerSite& site, ArrayStore& arrays) {
  ReliefNoise noise = prepared.noise;
  ReliefGround& ground = *prepared.ground;
  std::call_once(ground.once, [&] { ground.find(layer, source, site.ground()); });
  const ReliefTiles& tiles = ground.tiles;
  noise.low = ground.low, noise.step = ground.step;
  noise.count_x = tiles.count[0], noise.count_y = tiles.count[1], noise.count_z = tiles.count[2];
  const Vec3d origin = site.frame.origin * (1.0 / lattice_spacing(layer));
  noise.origin = to_float(origin - Vec3d{static_cast<double>(tiles.low[0]), static_cast<double>(tiles.low[1]),
                                         static_cast<double>(tiles.low[2])} *
                                       static_cast<double>(kReliefCell));
  if (layer.finer > 0 && !ground.places.empty()) {
    noise.below = place_levels(ground.levels, layer.finer, source.place, hash_append(source_hash(source), 5),
                               site, arrays, noise.detail);
    noise.below.words = arrays.add(pack_words(ground, ground.levels.codes));
  }
  noise.tiles = arrays.add(tiles.tiles);
  noise.splits = arrays.add(tiles.splits);
  noise.sheets = arrays.add(tiles.sheets);
  noise.words = arrays.add(pack_words(ground, ground.codes));
  noise.ranges = arrays.add(cell_code_ranges(tiles, ground.codes));
  for (const std::uint16_t code : ground.codes) {
    noise.height_bound =
        std::max(noise.height_bound, std::fabs(double{noise.low} + double{noise.step} * code));
  }
  noise.height_bound += std::max(-noise.below.least, noise.below.greatest);
  noise.height_bound *= 1.0 + 1e-5;
  return noise;
}

void evaluate_heights(const ReliefNoise& n, const ArrayView& arrays, int count, const float* x,
                      const float* y, const float* z, float* height) {
  if (n.count_x == 0) {
    std::fill_n(height, count, 0.0f);
    return;
  }
  const bool finer = n.below.levels.count > 0;
  std::vector<float> roughness(finer ? static_cast<std::size_t>(count) : 0);
  for (int i = 0; i < count; i += kChunk) {
    const ChunkPlaces places(n, arrays, std::min(kChunk, count - i), x + i, y + i, z + i);
    places.means(arrays[n.words], n.low, n.step, height + i);
    if (finer) places.means(arrays[n.below.words], 0.0f, n.below.step, roughness.data() + i);
  }
  if (finer) add_levels(n.below, arrays, count, x, y, z, roughness.data(), height);
}

}  // namespace astrolith
