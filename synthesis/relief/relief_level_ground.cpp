#include "synthesis/relief/relief_level_ground.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <limits>
#include <memory>

#include "numerics/hash_random.h"
#include "numerics/parallel_for.h"
#include "numerics/portable_double.h"
#include "synthesis/exemplar/exemplar_ground.h"

namespace astrolith {
namespace {

// In mean edges of the measured model; the last is the standard deviation of smoothing.
constexpr int kSide = 128, kPixelsPerEdge = 2;
constexpr double kHighPass = 1.5;

// A square of heights that repeats.
struct PeriodicHeights {
  int side;
  std::vector<double> values;

  explicit PeriodicHeights(int n)
      : side(n), values(static_cast<std::size_t>(n) * static_cast<std::size_t>(n)) {}
  std::size_t number(int x, int y) const {
    const auto inside = [this](int at) { return static_cast<std::size_t>((at % side + side) % side); };
    return inside(y) * static_cast<std::size_t>(side) + inside(x);
  }
  double at(int x, int y) const { return values[number(x, y)]; }
};

// An anchor in the plane and the donor of its patch.
struct PlaneAnchor {
  double x, y;  // pixels
  const ReliefAnchor* donor;
  PatchTurn turn;
};

// How much the base bends around each place: 1 less the length of the mean of normals there.
std::vector<double> bends(const ReliefPoints& points, double edge) {
  constexpr double kAround = 1.5;  // edges
  std::vector<double> squares(points.size(), 0.0), along(points.size());
  for (const Vec3d& axis : {Vec3d{1, 0, 0}, Vec3d{0, 1, 0}, Vec3d{0, 0, 1}}) {
    for (std::size_t i = 0; i < along.size(); ++i) along[i] = dot(points.normal(i), axis);
    const std::vector<double> means = smoothed_heights(points, along, kAround * edge);
    for (std::size_t i = 0; i < means.size(); ++i) squares[i] += means[i] * means[i];
  }
  for (double& square : squares) square = 1.0 - std::sqrt(square);
  return squares;
}

// The rougher half of the anchors, and of these the half about which the base bends least: patches of a
// smooth plain say little but how their heights were rounded, and heights over a crease of the base undo the
// crease.
std::vector<const ReliefAnchor*> plain_donors(const ReliefPatches& patches) {
  constexpr double kFlat = 1e-6;  // edges; less is rounding
  struct Donor {
    const ReliefAnchor* anchor;
    double bend;
  };
  const std::vector<double> place_bends = bends(patches.points(), patches.anchor_spacing().edge);
  std::vector<Donor> donors;
  for (const ReliefAnchor& anchor : patches.anchors()) {
    if (anchor.roughness < 0.5 || !(anchor.rms > kFlat * patches.anchor_spacing().edge)) continue;
    double most = 0.0;
    patches.points().for_each_near(
        anchor.at, anchor.up, 0.75 * patches.anchor_spacing().distance(),
        [&](std::uint32_t k, double, double) { most = std::max(most, place_bends[k]); });
    donors.push_back({&anchor, most});
  }
  std::stable_sort(donors.begin(), donors.end(),
                   [](const Donor& a, const Donor& b) { return a.bend < b.bend; });
  std::vector<const ReliefAnchor*> plain;
  for (std::size_t i = 0; i < (donors.size() + 1) / 2; ++i) plain.push_back(donors[i].anchor);
  return plain;
}

// A jittered lattice whose donors come round in turn, in an order of the hash.
std::vector<PlaneAnchor> plane_anchors(const ReliefPatches& patches,
                                       const std::vector<const ReliefAnchor*>& donors, std::uint32_t hash) {
  constexpr double kJitter = 0.15;  // of a cell, either way
  const int per_side = std::max(1, static_cast<int>(kSide / patches.anchor_spacing().edges + 0.5));
  const double cell = static_cast<double>(kSide * kPixelsPerEdge) / per_side;
  std::vector<std::uint32_t> order(donors.size());
  for (std::uint32_t i = 0; i < order.size(); ++i) order[i] = i;
  std::sort(order.begin(), order.end(), [&](std::uint32_t a, std::uint32_t b) {
    const std::uint32_t hash_a = hash_append(hash, a), hash_b = hash_append(hash, b);
    return hash_a != hash_b ? hash_a < hash_b : a < b;
  });
  std::vector<PlaneAnchor> anchors;
  for (int y = 0; y < per_side; ++y) {
    for (int x = 0; x < per_side; ++x) {
      const auto number = static_cast<std::uint32_t>(anchors.size());
      const std::uint32_t own = hash_append(hash_append(hash, 0x6a09e667u), number);
      const auto jittered = [&](int at, std::uint32_t axis) {
        return cell * (at + 0.5 + kJitter * (2.0 * double{unit_float(hash_append(own, axis))} - 1.0));
      };
      anchors.push_back({jittered(x, 0), jittered(y, 1), donors[order[number % order.size()]],
                         hash_to_turn(hash_append(own, 2))});
    }
  }
  return anchors;
}

// The pixels around an anchor. Farther ones have weights that count for nothing.
std::vector<PatchPoint> pixels_around(const PeriodicHeights& plane, const PlaneAnchor& anchor,
                                      const AnchorSpacing& spacing) {
  const double pixel = spacing.edge / kPixelsPerEdge, radius = spacing.radius() / pixel,
               reach = spacing.distance() / pixel;
  std::vector<PatchPoint> pixels;
  for (int y = static_cast<int>(std::floor(anchor.y - reach)); y <= anchor.y + reach; ++y) {
    for (int x = static_cast<int>(std::floor(anchor.x - reach)); x <= anchor.x + reach; ++x) {
      const double dx = x - anchor.x, dy = y - anchor.y, squared = dx * dx + dy * dy;
      if (squared > reach * reach) continue;
      pixels.push_back({static_cast<std::uint32_t>(plane.number(x, y)), dx * pixel, dy * pixel,
                        1.0 - squared / (radius * radius), 1.0});
    }
  }
  return pixels;
}

// What each anchor's patch gives to the pixels around it, over its roughness.
std::vector<std::vector<PatchHeight>> patches_in_plane(const ReliefPatches& patches,
                                                       const std::vector<PlaneAnchor>& anchors,
                                                       const PeriodicHeights& plane) {
  std::vector<std::vector<PatchHeight>> anchor_patches(anchors.size());
  parallel_for(0, static_cast<std::int64_t>(anchors.size()), [&](std::int64_t number) {
    const auto a = static_cast<std::size_t>(number);
    anchor_patches[a] = patches.heights_at(pixels_around(plane, anchors[a], patches.anchor_spacing()),
                                           *anchors[a].donor, anchors[a].turn);
    const double scale = 1.0 / anchors[a].donor->rms;
    for (PatchHeight& p : anchor_patches[a]) p.low *= scale, p.high *= scale;
  });
  return anchor_patches;
}

// The narrow heights of the patches, blended.
PeriodicHeights blended(const std::vector<std::vector<PatchHeight>>& anchor_patches, int side) {
  PeriodicHeights plane(side);
  std::vector<PatchSums> sums(plane.values.size());
  for (const std::vector<PatchHeight>& patch : anchor_patches) {
    for (const PatchHeight& p : patch)
      sums[p.number].add({p.number, p.low_weight, p.high_weight, 0.0, p.high});
  }
  for (std::size_t i = 0; i < sums.size(); ++i) plane.values[i] = sums[i].any() ? sums[i].height() : 0.0;
  return plane;
}

// Sums of squared second differences of all heights in a patch, along rows and columns, at two lags. Both are
// taken about the pixels that have the wider one.
struct SecondDifferences {
  double narrow = 0.0, wide = 0.0;
};
void add_second_differences(const std::vector<PatchHeight>& patch, int narrow, int wide,
                            PeriodicHeights& heights, SecondDifferences& sums) {
  std::fill(heights.values.begin(), heights.values.end(), std::numeric_limits<double>::quiet_NaN());
  for (const PatchHeight& p : patch) {
    if (p.low_weight > 0.0) heights.values[p.number] = p.low + p.high;
  }
  for (const PatchHeight& p : patch) {
    const int x = static_cast<int>(p.number) % heights.side, y = static_cast<int>(p.number) / heights.side;
    const auto squares = [&](int lag) {
      const double twice = 2.0 * heights.at(x, y);
      const double along_x = heights.at(x - lag, y) - twice + heights.at(x + lag, y),
                   along_y = heights.at(x, y - lag) - twice + heights.at(x, y + lag);
      return along_x * along_x + along_y * along_y;
    };
    const double narrow_square = squares(narrow), wide_square = squares(wide);
    if (std::isfinite(narrow_square + wide_square)) sums.narrow += narrow_square, sums.wide += wide_square;
  }
}

double fit_exponent(const std::vector<std::vector<PatchHeight>>& anchor_patches, int side) {
  constexpr double kLeast = 0.3, kMost = 1.5;
  PeriodicHeights heights(side);
  SecondDifferences sums;
  for (const std::vector<PatchHeight>& patch : anchor_patches) {
    add_second_differences(patch, kPixelsPerEdge, 4 * kPixelsPerEdge, heights, sums);
  }
  return sums.narrow > 0.0 ? std::clamp(0.25 * portable::log2(sums.wide / sums.narrow), kLeast, kMost)
                           : kMost;
}

// What the means around each pixel, with the weights of smoothed_heights(), leave of the heights.
PeriodicHeights high_passed(const PeriodicHeights& plane) {
  const double radius = std::sqrt(8.0) * kHighPass * kPixelsPerEdge;
  struct Tap {
    int x, y;
    double weight;
  };
  std::vector<Tap> taps;
  double total = 0.0;
  for (int y = static_cast<int>(-radius); y <= radius; ++y) {
    for (int x = static_cast<int>(-radius); x <= radius; ++x) {
      const double near = 1.0 - (x * x + y * y) / (radius * radius);
      if (near <= 0.0) continue;
      taps.push_back({x, y, portable::whole_power(near, 4)});
      total += taps.back().weight;
    }
  }
  PeriodicHeights passed(plane.side);
  parallel_for(0, plane.side, [&](std::int64_t row) {
    const int y = static_cast<int>(row);
    for (int x = 0; x < plane.side; ++x) {
      double sum = 0.0;
      for (const Tap& tap : taps) sum += tap.weight * plane.at(x + tap.x, y + tap.y);
      passed.values[plane.number(x, y)] = plane.at(x, y) - sum / total;
    }
  });
  return passed;
}

// An exemplar whose heights are those of the texture.
ExemplarLayer texture_exemplar(const ReliefTexture& texture) {
  const auto [least, most] = std::minmax_element(texture.heights.begin(), texture.heights.end());
  ExemplarLayer layer;
  layer.pixel_size = texture.pixel;
  layer.height_range = *most - *least;
  layer.exponent = 8;  // narrow seams: stones stay whole
  layer.rotation = ExemplarRotation::kAny;
  auto image = std::make_shared<ExemplarImage>();
  image->width = image->height = texture.side;
  for (const double height : texture.heights) {
    const double share = layer.height_range > 0.0 ? (height - *least) / layer.height_range : 0.0;
    image->values.push_back(static_cast<std::uint16_t>(share * 65535.0 + 0.5));
  }
  layer.pixels = std::move(image);
  return layer;
}

std::vector<double> relative_roughness(const ReliefPoints& points, const std::vector<double>& heights,
                                       double edge) {
  constexpr double kAround = 4.0;  // edges
  std::vector<double> squares = wide_heights(points, heights, edge);
  for (std::size_t i = 0; i < squares.size(); ++i) {
    const double narrow = heights[i] - squares[i];
    squares[i] = narrow * narrow;
  }
  squares = smoothed_heights(points, squares, kAround * edge);
  for (double& square : squares) square = std::sqrt(square);
  return squares;
}

}  // namespace

ReliefTexture relief_texture(const ReliefPatches& patches, std::uint32_t hash) {
  ReliefTexture texture;
  texture.side = kSide * kPixelsPerEdge;
  texture.pixel = patches.anchor_spacing().edge / kPixelsPerEdge;
  const std::vector<const ReliefAnchor*> donors = plain_donors(patches);
  if (donors.empty()) {
    texture.heights = PeriodicHeights(texture.side).values;
    return texture;
  }
  const std::vector<std::vector<PatchHeight>> anchor_patches =
      patches_in_plane(patches, plane_anchors(patches, donors, hash), PeriodicHeights(texture.side));
  texture.exponent = fit_exponent(anchor_patches, texture.side);
  texture.heights = high_passed(blended(anchor_patches, texture.side)).values;
  return texture;
}

LevelGround level_ground(const ReliefPatches& patches, const ReliefPoints& points,
                         const std::vector<double>& heights, std::uint32_t hash) {
  const ReliefTexture texture = relief_texture(patches, hash);
  LevelGround ground{texture_exemplar(texture), texture.exponent, {}, 0.0f};
  const std::vector<double> roughness = relative_roughness(points, heights, patches.anchor_spacing().edge);
  const double most = roughness.empty() ? 0.0 : *std::max_element(roughness.begin(), roughness.end());
  ground.step = static_cast<float>(most / 65535.0);
  for (const double height : roughness) {
    const double code = ground.step > 0.0f ? height / double{ground.step} : 0.0;
    ground.codes.push_back(static_cast<std::uint16_t>(std::clamp(std::floor(code + 0.5), 0.0, 65535.0)));
  }
  return ground;
}

ReliefLevels place_levels(const LevelGround& ground, int count, const std::string& place, std::uint32_t hash,
                          const LayerSite& site, ArrayStore& arrays, NoiseDetail& detail) {
  ReliefLevels placed;
  if (!(ground.texture.height_range > 0.0) || !(ground.step > 0.0f)) return placed;
  const ExemplarNoise made = make_exemplar(ground.texture, place, arrays);
  ExemplarLayer layer = ground.texture;
  std::vector<ReliefLevel> levels;
  double total = 0.0, left_out = 0.0, gains = 0.0;
  for (int k = 1; k <= count; ++k) {
    layer.pixel_size *= 0.25;
    const double gain = portable::exp(-k * ground.exponent * portable::log(4.0));
    const ExemplarNoise noise = placed_exemplar(made, layer, hash_append(hash, static_cast<std::uint32_t>(k)),
                                                0, site, false, arrays);
    total += gain * gain;
    if (noise.lattice.anchors.count == 0) {
      left_out += gain * gain;
      continue;
    }
    gains += gain;
    levels.push_back({noise, static_cast<float>(gain)});
  }
  detail.finest = std::min(detail.finest, layer.pixel_size);
  detail.left_out = left_out / total;
  const double most = 65535.0 * double{ground.step} * gains * (1.0 + 1e-5);
  placed.levels = arrays.add(levels);
  placed.step = ground.step;
  placed.least = most * std::min(made.texture.least, 0.0);
  placed.greatest = most * std::max(made.texture.greatest, 0.0);
  return placed;
}

}  // namespace astrolith
