#include "synthesis/exemplar/exemplar_noise.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <vector>

#include "numerics/hash_random.h"
#include "synthesis/exemplar/exemplar_ground.h"
#include "synthesis/noise/points_in_domain.h"

namespace astrolith {
namespace {

// Points and their places in the lattice, as arrays.
struct PlaceArrays {
  std::vector<float> values;  // x, y, z and four weights of each point
  std::vector<std::int32_t> tetrahedra;

  explicit PlaceArrays(std::size_t n) : values(7 * n), tetrahedra(n) {}
  float* array(std::size_t k) { return values.data() + k * tetrahedra.size(); }
  const float* array(std::size_t k) const { return values.data() + k * tetrahedra.size(); }
};

// Writes the places of the points. The number of a tetrahedron is 8 * anchor + order.
ASTROLITH_SIMD_CLONES void find_places(const ExemplarLattice& shared_lattice, int n,
                                       const float* __restrict px, const float* __restrict py,
                                       const float* __restrict pz, float* __restrict x, float* __restrict y,
                                       float* __restrict z, float* __restrict w0, float* __restrict w1,
                                       float* __restrict w2, float* __restrict w3,
                                       std::int32_t* __restrict tetrahedron) {
  const ExemplarLattice lattice = shared_lattice;
#pragma omp simd
  for (int i = 0; i < n; ++i) {
    const ExemplarPlace place = exemplar_place(lattice, px[i], py[i], pz[i]);
    x[i] = place.x, y[i] = place.y, z[i] = place.z;
    w0[i] = place.weight[0], w1[i] = place.weight[1], w2[i] = place.weight[2], w3[i] = place.weight[3];
    tetrahedron[i] = 8 * place.anchor + place.order;
  }
}

// sharpen_weights() at n points, bit for bit: powers of one anchor's weights, and the sum of their squares.
ASTROLITH_SIMD_CLONES void raise_weights(std::int32_t exponent, int n, float* __restrict weight,
                                         float* __restrict plain, float* __restrict squares) {
  std::copy_n(weight, n, plain);
#pragma omp simd
  for (int i = 0; i < n; ++i) weight[i] = plain[i] * plain[i];
  for (std::int32_t e = 2; e < exponent; ++e) {
#pragma omp simd
    for (int i = 0; i < n; ++i) weight[i] *= plain[i];
  }
#pragma omp simd
  for (int i = 0; i < n; ++i) squares[i] = math::fma(weight[i], weight[i], squares[i]);
}

ASTROLITH_SIMD_CLONES void divide_by_root(int n, float* __restrict weight, const float* __restrict squares) {
#pragma omp simd
  for (int i = 0; i < n; ++i) weight[i] *= 1.0f / math::sqrt(squares[i]);
}

void sharpen(std::int32_t exponent, int n, const std::array<float*, 4>& weights) {
  std::vector<float> plain(static_cast<std::size_t>(n)), squares(plain.size(), 0.0f);
  for (float* weight : weights) raise_weights(exponent, n, weight, plain.data(), squares.data());
  for (float* weight : weights) divide_by_root(n, weight, squares.data());
}

// Adds one anchor's part to z at n points of one tetrahedron.
ASTROLITH_SIMD_CLONES void add_anchor(const ExemplarTexture& shared_texture, const std::uint32_t* words,
                                      const ExemplarAnchor& shared_anchor, int n, const float* __restrict x,
                                      const float* __restrict y, const float* __restrict z,
                                      const float* __restrict weight, float* __restrict sum) {
  const ExemplarTexture texture = shared_texture;
  const ExemplarAnchor anchor = shared_anchor;
#pragma omp simd
  for (int i = 0; i < n; ++i) {
    sum[i] = math::fma(weight[i], anchor_value(texture, words, anchor, x[i], y[i], z[i]), sum[i]);
  }
}

ASTROLITH_SIMD_CLONES void look_up(const float* heights, int n, float* __restrict values) {
#pragma omp simd
  for (int i = 0; i < n; ++i) values[i] = exemplar_height(heights, values[i]);
}

// Sorts points by their tetrahedra: a group is a run of points of one tetrahedron in `order`.
struct PointGroups {
  std::vector<std::int32_t> order;  // numbers of the points; empty: one group, as they were given
  std::vector<int> first;           // first point of each group, and the number of points
};

// More groups than this in one call are sorted; fewer are found in a list.
constexpr std::size_t kMostListedGroups = 24;

// Writes the number of each point's tetrahedron in the list of all that occur. Returns the list, or an empty
// one where more than kMostListedGroups occur.
std::vector<std::int32_t> listed_tetrahedra(const std::vector<std::int32_t>& tetrahedra,
                                            std::vector<std::int32_t>& number) {
  std::vector<std::int32_t> list;
  std::int32_t last = -1;
  for (std::size_t i = 0; i < tetrahedra.size(); ++i) {
    if (last < 0 || list[static_cast<std::size_t>(last)] != tetrahedra[i]) {
      const auto found = std::find(list.begin(), list.end(), tetrahedra[i]);
      last = static_cast<std::int32_t>(found - list.begin());
      if (found == list.end()) {
        if (list.size() == kMostListedGroups) return {};
        list.push_back(tetrahedra[i]);
      }
    }
    number[i] = last;
  }
  return list;
}

// Points of one group stand together, in the order in which they were given.
PointGroups groups_in_list(const std::vector<std::int32_t>& number, std::size_t groups) {
  PointGroups result;
  result.first.assign(groups + 1, 0);
  for (const std::int32_t g : number) ++result.first[static_cast<std::size_t>(g) + 1];
  for (std::size_t g = 0; g < groups; ++g) result.first[g + 1] += result.first[g];
  if (groups == 1) return result;
  std::vector<int> next = result.first;
  result.order.resize(number.size());
  for (std::size_t i = 0; i < number.size(); ++i) {
    const auto at = static_cast<std::size_t>(next[static_cast<std::size_t>(number[i])]++);
    result.order[at] = static_cast<std::int32_t>(i);
  }
  return result;
}

PointGroups group_points(const std::vector<std::int32_t>& tetrahedra) {
  const std::size_t n = tetrahedra.size();
  std::vector<std::int32_t> number(n);
  const std::vector<std::int32_t> list = listed_tetrahedra(tetrahedra, number);
  if (!list.empty()) return groups_in_list(number, list.size());
  std::vector<std::uint64_t> keys(n);
  for (std::size_t i = 0; i < n; ++i) {
    keys[i] = static_cast<std::uint64_t>(static_cast<std::uint32_t>(tetrahedra[i])) << 32 | i;
  }
  std::sort(keys.begin(), keys.end());
  PointGroups groups;
  groups.order.resize(n);
  for (std::size_t i = 0; i < n; ++i) {
    groups.order[i] = static_cast<std::int32_t>(keys[i] & 0xffffffffu);
    if (i == 0 || keys[i] >> 32 != keys[i - 1] >> 32) groups.first.push_back(static_cast<int>(i));
  }
  groups.first.push_back(static_cast<int>(n));
  return groups;
}

// The places in the order of the groups.
PlaceArrays sorted_places(const PlaceArrays& places, const PointGroups& groups) {
  const std::size_t n = groups.order.size();
  PlaceArrays result(n);
  for (std::size_t k = 0; k < 7; ++k) {
    const float* from = places.array(k);
    float* to = result.array(k);
    for (std::size_t i = 0; i < n; ++i) to[i] = from[groups.order[i]];
  }
  for (std::size_t i = 0; i < n; ++i) {
    result.tetrahedra[i] = places.tetrahedra[static_cast<std::size_t>(groups.order[i])];
  }
  return result;
}

}  // namespace

ExemplarNoise make_exemplar(const ExemplarLayer& layer, const std::string& place, ArrayStore& arrays) {
  ExemplarNoise noise;
  noise.texture = make_exemplar_texture(layer, place, arrays);
  noise.exponent = layer.exponent;
  noise.height_bound = std::max(std::fabs(noise.texture.least), std::fabs(noise.texture.greatest));
  noise.detail.finest = layer.pixel_size;
  return noise;
}

ExemplarNoise placed(const ExemplarLayer& layer, const ExemplarNoise& prepared, const LayerSource& source,
                     const LayerSite& site, ArrayStore& arrays) {
  return placed_exemplar(prepared, layer, source.recipe.seed, source.number, site, true, arrays);
}

ExemplarNoise placed_exemplar(const ExemplarNoise& made, const ExemplarLayer& layer, std::uint64_t seed,
                              int layer_index, const LayerSite& site, bool on_layers, ArrayStore& arrays) {
  const BodyGround body = site.ground();
  const ExemplarGround ground =
      on_layers ? ExemplarGround{body, site.below, site.height_bound} : ExemplarGround{body};
  NoiseFrame frame = site.frame;
  ExemplarNoise noise = made;
  noise.lifted = static_cast<bool>(ground.below);
  noise.lattice.anchors = {};
  const double edge = exemplar_edge(layer);
  noise.detail.left_out = 1.0;
  if (!(frame.farthest() / layer.pixel_size <= kLargestCell)) return noise;
  ExemplarCells cells = exemplar_cells(frame, {edge, edge, edge});
  if (!(cells.anchors <= kMostExemplarAnchors) && !frame.moved) {
    const Box surface = site.surface();
    if (surface.empty()) return noise;
    frame.domain = widened(surface, site.height_bound);
    cells = exemplar_cells(frame, {edge, edge, edge});
  }
  if (!(cells.anchors <= kMostExemplarAnchors)) return noise;
  noise.low = to_float(frame.domain.min);
  noise.high = to_float(frame.domain.max);
  noise.detail.left_out = 0.0;
  noise.lattice = cells.lattice;
  noise.lattice.anchors = arrays.add(
      anchors_on_body(layer, cells, hash_seed(seed, static_cast<std::uint32_t>(layer_index)), ground));
  return noise;
}

void evaluate_heights(const ExemplarNoise& n, const ArrayView& arrays, int count, const float* x,
                      const float* y, const float* z, float* height) {
  std::fill(height, height + count, 0.0f);
  if (n.lattice.anchors.count == 0) return;
  evaluate_heights(n, arrays, arrays[n.lattice.anchors], count, x, y, z, height);
}

void evaluate_heights(const ExemplarNoise& n, const ArrayView& arrays, const ExemplarAnchor* anchors,
                      int count, const float* x, const float* y, const float* z, float* height) {
  if (count == 0) return;
  const PointsInDomain p(n.low, n.high, count, x, y, z);
  PlaceArrays places(static_cast<std::size_t>(count));
  find_places(n.lattice, count, p.x(), p.y(), p.z(), places.array(0), places.array(1), places.array(2),
              places.array(3), places.array(4), places.array(5), places.array(6), places.tetrahedra.data());
  sharpen(n.exponent, count, {places.array(3), places.array(4), places.array(5), places.array(6)});
  const PointGroups groups = group_points(places.tetrahedra);
  if (!groups.order.empty()) places = sorted_places(places, groups);
  std::vector<float> sums(static_cast<std::size_t>(count));
  for (std::size_t g = 0; g + 1 < groups.first.size(); ++g) {
    const int first = groups.first[g], size = groups.first[g + 1] - first;
    const std::int32_t tetrahedron = places.tetrahedra[static_cast<std::size_t>(first)];
    for (int c = 0; c < 4; ++c) {
      const ExemplarAnchor anchor =
          anchor_at_corner(n.lattice, anchors, tetrahedron >> 3, tetrahedron & 7, c);
      add_anchor(n.texture, arrays[n.texture.words], anchor, size, places.array(0) + first,
                 places.array(1) + first, places.array(2) + first,
                 places.array(static_cast<std::size_t>(3 + c)) + first, sums.data() + first);
    }
  }
  look_up(arrays[n.texture.heights], count, sums.data());
  for (std::size_t i = 0; i < sums.size(); ++i) {
    height[groups.order.empty() ? i : static_cast<std::size_t>(groups.order[i])] = sums[i];
  }
}

}  // namespace astrolith
