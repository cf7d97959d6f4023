#include "synthesis/relief/relief_likeness.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <optional>
#include <utility>

#include "numerics/errors.h"
#include "numerics/hash_random.h"
#include "numerics/parallel_for.h"
#include "numerics/portable_double.h"
#include "numerics/sample_statistics.h"
#include "synthesis/relief/relief_anchors.h"
#include "synthesis/relief/relief_shares.h"
#include "synthesis/relief/relief_values.h"

namespace astrolith {
namespace {

// In mean edges of the measured model: standard deviations of smoothing.
constexpr std::array<double, 3> kEqualBands = {0.7, 1.4, 2.8};
constexpr std::size_t kFewestAnchors = 10;

// Anchors of a body, and for each the anchor of the measured body that gives its patch.
struct DrawnAnchors {
  std::vector<ReliefAnchor> anchors, donors;
};

DrawnAnchors draw_anchors(std::vector<ReliefAnchor> anchors, const std::vector<ReliefAnchor>& measured,
                          const LikenessOptions& options) {
  DrawnAnchors drawn{std::move(anchors), {}};
  for (const std::uint32_t donor :
       relief_donors(drawn.anchors, measured, options.reach, options.fill, hash_append(options.hash, 1))) {
    drawn.donors.push_back(measured[donor]);
  }
  return drawn;
}

// The points around an anchor.
std::vector<PatchPoint> points_around(const ReliefPoints& points, const ReliefAnchor& anchor, double radius) {
  std::vector<PatchPoint> around;
  points.for_each_near(anchor.at, anchor.up, radius, [&](std::uint32_t k, double squared, double facing) {
    const Vec3d offset = points.at(k) - anchor.at;
    const double x = dot(offset, anchor.right), y = dot(offset, anchor.ahead);
    const double across = std::sqrt(x * x + y * y), scale = across > 0.0 ? norm(offset) / across : 0.0;
    around.push_back({k, scale * x, scale * y, 1.0 - squared / (radius * radius), facing});
  });
  return around;
}

// The sums of the patches at the points.
std::vector<PatchSums> sums_of(const ReliefPatches& patches, const ReliefPoints& points,
                               const DrawnAnchors& drawn, std::uint32_t hash) {
  constexpr std::size_t kTogether = 256;  // anchors whose patches are kept at a time
  std::vector<PatchSums> sums(points.size());
  for (std::size_t first = 0; first < drawn.anchors.size(); first += kTogether) {
    std::vector<std::vector<PatchHeight>> of_anchor(std::min(kTogether, drawn.anchors.size() - first));
    parallel_for(0, static_cast<std::int64_t>(of_anchor.size()), [&](std::int64_t number) {
      const std::size_t a = first + static_cast<std::size_t>(number);
      const PatchTurn turn = turn_of(hash_append(hash_append(hash, 2), static_cast<std::uint32_t>(a)));
      of_anchor[a - first] = patches.heights_at(
          points_around(points, drawn.anchors[a], patches.anchor_spacing().radius()), drawn.donors[a], turn);
    });
    for (const std::vector<PatchHeight>& patch : of_anchor) {
      for (const PatchHeight& p : patch) sums[p.number].add(p);
    }
  }
  return sums;
}

// The heights at the points; where no patch has a weight, those of `otherwise`.
std::vector<double> blended(const ReliefPatches& patches, const ReliefPoints& points,
                            const DrawnAnchors& drawn, const std::vector<double>& otherwise,
                            std::uint32_t hash) {
  const std::vector<PatchSums> sums = sums_of(patches, points, drawn, hash);
  std::vector<double> heights(points.size());
  for (std::size_t i = 0; i < heights.size(); ++i) {
    heights[i] = sums[i].any() ? sums[i].height() : otherwise[i];
  }
  return heights;
}

// Heights in bands, from fine to wide, and what all smoothing leaves. Their sum is the heights.
struct Bands {
  ThreeFields narrow;
  std::vector<double> rest;

  Bands(const ReliefPoints& points, const std::vector<double>& heights, double edge) : rest(heights) {
    for (std::size_t band = 0; band < narrow.size(); ++band) {
      std::vector<double> smooth = smoothed_heights(points, rest, kEqualBands[band] * edge);
      for (std::size_t i = 0; i < rest.size(); ++i) rest[i] -= smooth[i];
      narrow[band] = std::exchange(rest, std::move(smooth));
    }
  }
};

// The geometric mean over the body of the root mean square around a place, for each band. A mean of squares
// would be that of few rough places. With `seen_alone` places below a seventh of the third quartile do not
// count.
std::array<double, 3> typical_rms(const ReliefPoints& points, ThreeFields bands, double edge,
                                  bool seen_alone) {
  constexpr double kAround = 3.0, kLeast = 1e-12;  // edges; of the largest square
  for (std::vector<double>& band : bands) {
    for (double& height : band) height *= height;
  }
  const SampledMeans sampled = sampled_means(points, bands, kAround * edge);
  std::array<double, 3> rms{};
  for (std::size_t band = 0; band < bands.size(); ++band) {
    const double largest = *std::max_element(bands[band].begin(), bands[band].end());
    if (!(largest > 0.0)) continue;
    const std::vector<double>& around = sampled.means[band];
    const double least = seen_alone ? ranked_value(around, around.size() * 3 / 4) / 49.0 : 0.0;
    double total = 0.0, logarithms = 0.0;
    for (std::size_t i = 0; i < around.size(); ++i) {
      if (around[i] < least) continue;
      const double weight = points.weight(sampled.places[i]);
      total += weight;
      logarithms += weight * portable::log(std::max(around[i] / largest, kLeast));
    }
    rms[band] = std::sqrt(largest * portable::exp(logarithms / total));
  }
  return rms;
}

// Heights whose bands are as strong as those that were measured: blends and resampling take from each a share
// of its own.
std::vector<double> equalized(const ReliefPoints& points, const std::vector<double>& heights,
                              const ReliefPoints& of_measured, const std::vector<double>& measured,
                              double edge, bool seen_alone) {
  constexpr double kMostGain = 2.0;  // of all bands but the finest, which would be noise
  const std::array<double, 3> wants =
      typical_rms(of_measured, Bands(of_measured, measured, edge).narrow, edge, seen_alone);
  const Bands bands(points, heights, edge);
  const std::array<double, 3> has = typical_rms(points, bands.narrow, edge, seen_alone);
  std::vector<double> sum = bands.rest;
  for (std::size_t band = 0; band < has.size(); ++band) {
    const double most = band == 0 ? 1.0 : kMostGain;
    const double gain = has[band] > 0.0 ? std::min(wants[band] / has[band], most) : 1.0;
    for (std::size_t i = 0; i < sum.size(); ++i) sum[i] += gain * bands.narrow[band][i];
  }
  return sum;
}

}  // namespace

std::vector<double> like_heights(const std::vector<ReliefPlace>& places, const ReliefTiles& tiles,
                                 const ReliefPatches& patches, bool foreign, double spacing,
                                 const LikenessOptions& options, const std::string& where) {
  const std::vector<ReliefAnchor>& anchors = patches.anchors();
  const std::vector<double>& measured = patches.measured().heights;
  const AnchorSpacing& apart = patches.anchor_spacing();
  if (anchors.size() < kFewestAnchors) {
    throw InputError(where + ": the body has room for " + std::to_string(anchors.size()) +
                     " patches of its relief, and a body of its kind needs " +
                     std::to_string(kFewestAnchors) +
                     "; keep the arrangement measured, or fit a finer model");
  }
  if (places.empty()) return {};  // a base that is smaller than the spacing
  std::optional<ReliefPoints> others;
  if (foreign) others.emplace(places, spacing);
  const ReliefPoints& points = foreign ? *others : patches.points();
  const ReliefValues blend(points, ReliefShares(places, tiles, spacing));
  const DrawnAnchors drawn =
      draw_anchors(foreign ? relief_anchors(points, {}, apart.distance(), 0.0) : anchors, anchors, options);
  const std::vector<double> otherwise =
      foreign ? std::vector<double>(places.size()) : blend.values_of(measured);
  const std::vector<double> values = blended(patches, points, drawn, otherwise, options.hash);
  return equalized(points, blend.coefficients_of(values), patches.points(), measured, apart.edge,
                   options.fill);
}

std::vector<double> filled_heights(const ReliefPatches& patches, double spacing,
                                   const LikenessOptions& options) {
  const MeasuredRelief& measured = patches.measured();
  const ReliefPoints& points = patches.points();
  DrawnAnchors unseen;
  std::vector<double> weights(points.size(), 0.0);  // of wide heights of all anchors
  const DrawnAnchors drawn = draw_anchors(patches.anchors(), patches.anchors(), options);
  for (std::size_t a = 0; a < drawn.anchors.size(); ++a) {
    const ReliefAnchor& anchor = drawn.anchors[a];
    for (const PatchPoint& p : points_around(points, anchor, patches.anchor_spacing().radius())) {
      weights[p.number] += wide_weight(p);
    }
    if (anchor.unseen) unseen.anchors.push_back(anchor), unseen.donors.push_back(drawn.donors[a]);
  }
  if (unseen.anchors.empty()) return measured.heights;
  const ReliefValues blend(points, ReliefShares(measured.places, measured.tiles, spacing));
  const std::vector<PatchSums> sums = sums_of(patches, points, unseen, options.hash);
  std::vector<double> change = blend.values_of(measured.heights);
  for (std::size_t i = 0; i < change.size(); ++i) {
    change[i] = sums[i].any() ? sums[i].low_weight / weights[i] * (sums[i].height() - change[i]) : 0.0;
  }
  std::vector<double> heights = blend.coefficients_of(change);
  for (std::size_t i = 0; i < heights.size(); ++i) heights[i] += measured.heights[i];
  return heights;
}

}  // namespace astrolith
