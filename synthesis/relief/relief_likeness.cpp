#include "synthesis/relief/relief_likeness.h"

#include <algorithm>
#include <cmath>
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
constexpr double kEqualBands[] = {0.7, 1.4, 2.8};
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
  std::vector<std::vector<PatchHeight>> of_anchor(drawn.anchors.size());
  parallel_for(0, static_cast<std::int64_t>(of_anchor.size()), [&](std::int64_t number) {
    const auto a = static_cast<std::size_t>(number);
    const PatchTurn turn = turn_of(hash_append(hash_append(hash, 2), static_cast<std::uint32_t>(a)));
    of_anchor[a] = patches.heights_at(
        points_around(points, drawn.anchors[a], patches.anchor_spacing().radius()), drawn.donors[a], turn);
  });
  std::vector<PatchSums> sums(points.size());
  for (const std::vector<PatchHeight>& patch : of_anchor) {
    for (const PatchHeight& p : patch) sums[p.number].add(p);
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

// Heights in bands, from fine to wide; the last is what all smoothing leaves. Their sum is the heights.
std::vector<std::vector<double>> bands_of(const ReliefPoints& points, std::vector<double> heights,
                                          double edge) {
  std::vector<std::vector<double>> bands;
  for (const double sigma : kEqualBands) {
    std::vector<double> smooth = smoothed_heights(points, heights, sigma * edge);
    for (std::size_t i = 0; i < heights.size(); ++i) heights[i] -= smooth[i];
    bands.push_back(std::move(heights));
    heights = std::move(smooth);
  }
  bands.push_back(std::move(heights));
  return bands;
}

// The geometric mean over the body of the root mean square around a place. A mean of squares would be that of
// few rough places. With `seen_alone` places below a seventh of the third quartile do not count.
double typical_rms(const ReliefPoints& points, const std::vector<double>& heights, double edge,
                   bool seen_alone) {
  constexpr double kAround = 3.0, kLeast = 1e-12;  // edges; of the largest square
  std::vector<double> squares(heights.size());
  for (std::size_t i = 0; i < heights.size(); ++i) squares[i] = heights[i] * heights[i];
  const double largest = *std::max_element(squares.begin(), squares.end());
  if (!(largest > 0.0)) return 0.0;
  double total = 0.0, logarithms = 0.0, least = 0.0;
  const std::vector<double> around = smoothed_heights(points, squares, kAround * edge);
  if (seen_alone) least = ranked_value(around, around.size() * 3 / 4) / 49.0;
  for (std::size_t i = 0; i < around.size(); ++i) {
    if (around[i] < least) continue;
    total += points.weight(i);
    logarithms += points.weight(i) * portable::log(std::max(around[i] / largest, kLeast));
  }
  return std::sqrt(largest * portable::exp(logarithms / total));
}

// Heights whose bands are as strong as those that were measured: blends and resampling take from each a share
// of its own.
std::vector<double> equalized(const ReliefPoints& points, const std::vector<double>& heights,
                              const ReliefPoints& of_measured, const std::vector<double>& measured,
                              double edge, bool seen_alone) {
  constexpr double kMostGain = 2.0;  // of all bands but the finest, which would be noise
  const std::vector<std::vector<double>> bands = bands_of(points, heights, edge),
                                         wanted = bands_of(of_measured, measured, edge);
  std::vector<double> sum = bands.back();
  for (std::size_t band = 0; band + 1 < bands.size(); ++band) {
    const double has = typical_rms(points, bands[band], edge, seen_alone),
                 wants = typical_rms(of_measured, wanted[band], edge, seen_alone);
    const double most = band == 0 ? 1.0 : kMostGain;
    const double gain = has > 0.0 ? std::min(wants / has, most) : 1.0;
    for (std::size_t i = 0; i < sum.size(); ++i) sum[i] += gain * bands[band][i];
  }
  return sum;
}

}  // namespace

std::vector<double> like_heights(const std::vector<ReliefPlace>& places, const ReliefPatches& patches,
                                 bool foreign, double spacing, const LikenessOptions& options,
                                 const std::string& where) {
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
  const ReliefPoints points(places, spacing);
  const ReliefValues blend(points, ReliefShares(places, spacing));
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
  const ReliefValues blend(points, ReliefShares(measured.places, spacing));
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
