#include "synthesis/relief/relief_likeness.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <optional>

#include "numerics/errors.h"
#include "numerics/hash_random.h"
#include "numerics/portable_double.h"
#include "numerics/sample_statistics.h"
#include "synthesis/relief/relief_donors.h"
#include "synthesis/relief/relief_laying.h"
#include "synthesis/relief/relief_matching.h"
#include "synthesis/relief/relief_tiles.h"
#include "synthesis/relief/relief_values.h"

namespace astrolith {
namespace {

constexpr std::size_t kFewestAnchors = 10;
// Edges: standard deviations of the means over which the base counts as smooth.
constexpr double kNarrowBends = 4.0, kWideBends = 14.0;

void add(const std::vector<double>& heights, std::vector<double>& sum, double gain = 1.0) {
  for (std::size_t i = 0; i < sum.size(); ++i) sum[i] += gain * heights[i];
}

using BandRms = std::array<double, kReliefBands>;

// The strength r of a band, from the mean squares q around some places. With `seen_alone` places below a
// seventh of the third quartile do not count.
double typical_rms(const ReliefPoints& points, const std::vector<std::uint32_t>& places,
                   const std::vector<double>& squares, bool seen_alone) {
  constexpr double kLeast = 1e-12;  // of the largest square
  const double largest = *std::max_element(squares.begin(), squares.end());
  if (!(largest > 0.0)) return 0.0;
  const double least = seen_alone ? ranked_value(squares, squares.size() * 3 / 4) / 49.0 : 0.0;
  double total = 0.0, logarithms = 0.0;
  for (std::size_t i = 0; i < squares.size(); ++i) {
    if (squares[i] < least) continue;
    const double weight = points.weight(places[i]);
    total += weight;
    logarithms += weight * portable::log(std::max(squares[i] / largest, kLeast));
  }
  return std::sqrt(largest * portable::exp(logarithms / total));
}

BandRms typical_rms(const ReliefPoints& points, const BandHeights& bands, double edge, bool seen_alone) {
  constexpr std::array<double, 2> kAround = {3.0, 12.0};  // edges: for the three narrow bands, and the others
  BandRms rms{};
  for (std::size_t set = 0; set < kAround.size(); ++set) {
    ThreeFields squares;
    for (std::size_t k = 0; k < squares.size(); ++k) {
      squares[k] = bands[std::min(3 * set + k, kReliefBands - 1)];
      for (double& height : squares[k]) height *= height;
    }
    const SampledMeans sampled = sampled_means(points, squares, kAround[set] * edge);
    for (std::size_t k = 0; k < squares.size() && 3 * set + k < kReliefBands; ++k)
      rms[3 * set + k] = typical_rms(points, sampled.places, sampled.means[k], seen_alone);
  }
  return rms;
}

BandHeights evaluate(const ReliefValues& blend, BandHeights bands) {
  for (std::vector<double>& band : bands) band = blend.evaluate(band);
  return bands;
}

// Coefficients of what has been laid, with bands as strong as those that were measured: seams take from each
// a share of its own. The bands are those of the sum, since what was laid in several bands no longer agrees.
std::vector<double> equalized(const ReliefPoints& points, const ReliefValues& blend,
                              const std::vector<LaidHeights>& laid, const BandRms& wants, double edge,
                              bool seen_alone) {
  constexpr double kMostGain = 2.0;
  std::vector<double> sum;
  for (const LaidHeights& place : laid) sum.push_back(place.sum());
  ReliefBands bands(points, blend.solve(sum), edge);
  const BandRms has = typical_rms(points, evaluate(blend, bands.bands), edge, seen_alone);
  for (std::size_t b = 0; b < kReliefBands; ++b)
    add(bands.bands[b], bands.rest, has[b] > 0.0 ? std::min(wants[b] / has[b], kMostGain) : 1.0);
  return std::move(bands.rest);
}

ReliefValues measured_blend(const ReliefPatches& patches, double spacing) {
  const MeasuredRelief& measured = patches.measured();
  return {patches.points(), ReliefShares(measured.places, measured.tiles, spacing)};
}

// What is narrow of the bare surface itself: the mean of (n + n_j) . (p - p_j) / 2 over the places p_j around
// each place p, with their normals. It is 0 on spheres and, to the second order, on all surfaces without
// narrow bends, however the places lie. `around` is the standard deviation of the mean, length units.
std::vector<double> base_details(const ReliefPoints& points, double around) {
  ThreeFields at, normals, along;
  for (std::size_t i = 0; i < points.size(); ++i) {
    const Vec3d &p = points.at(i), &n = points.normal(i);
    at[0].push_back(p.x), at[1].push_back(p.y), at[2].push_back(p.z);
    normals[0].push_back(n.x), normals[1].push_back(n.y), normals[2].push_back(n.z);
    along[0].push_back(dot(n, p));
  }
  at = smoothed_fields(points, at, around);
  normals = smoothed_fields(points, normals, around);
  along[0] = smoothed_heights(points, along[0], around);
  std::vector<double> details;
  for (std::size_t i = 0; i < points.size(); ++i) {
    const Vec3d offset = points.at(i) - Vec3d{at[0][i], at[1][i], at[2][i]},
                normal{normals[0][i], normals[1][i], normals[2][i]};
    details.push_back(0.5 * (dot(points.normal(i), offset) + dot(normal, points.at(i)) - along[0][i]));
  }
  return details;
}

// The bands of the measured surface, as coefficients. Heights alone would carry what makes up for the bends
// of the base to places where the base has others.
ReliefBands surface_bands(const ReliefPatches& patches, const ReliefValues& blend) {
  const double edge = patches.anchor_spacing().edge;
  std::vector<double> heights = blend.solve(base_details(patches.points(), kNarrowBends * edge));
  add(patches.measured().heights, heights);
  return {patches.points(), heights, edge};
}

// The values of a surface at the places, as heights over a smooth one.
std::vector<double> surface_values(const ReliefPoints& points, const ReliefValues& blend,
                                   const std::vector<double>& heights, double edge) {
  std::vector<double> values = blend.evaluate(heights);
  add(base_details(points, kWideBends * edge), values);
  return values;
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
  const ReliefPoints& measured_points = patches.points();
  std::optional<ReliefPoints> others;
  if (foreign) others.emplace(places, spacing);
  const ReliefPoints& points = foreign ? *others : measured_points;
  const ReliefValues blend(points, ReliefShares(places, tiles, spacing));
  const ReliefValues donor_blend = foreign ? measured_blend(patches, spacing) : blend;
  ReliefBands bands = surface_bands(patches, donor_blend);
  if (foreign) add(bands.rest, bands.bands.back());
  const BandRms wants =
      typical_rms(measured_points, evaluate(donor_blend, bands.bands), apart.edge, options.fill);
  const std::vector<ReliefAnchor> own = foreign ? relief_anchors(points, apart.distance()) : anchors;
  std::vector<LaidHeights> laid(points.size());
  lay_patches(patches, bands.bands, points, own, ReliefDonors(patches, own, options.reach, options.fill),
              options.hash, laid);
  std::vector<double> heights = equalized(points, blend, laid, wants, apart.edge, options.fill);
  if (!foreign) {
    add(measured, heights);
    for (const std::vector<double>& band : bands.bands) add(band, heights, -1.0);
  }
  if (!options.matched || options.fill) return heights;
  const std::vector<double> whole = surface_values(measured_points, donor_blend, measured, apart.edge),
                            drawn = surface_values(points, blend, heights, apart.edge);
  add(matched_change({measured_points, whole}, {points, drawn}, blend, apart.edge,
                     hash_append(options.hash, 6)),
      heights);
  return heights;
}

namespace {

// How much the heights of a place that was seen stand against those laid over it: not at all on ground as
// smooth as what was not seen, in full where the mean square is twice that.
float seen_cover(double squares, double smoothest) {
  if (!(squares > smoothest)) return 0.0f;
  return smoothest > 0.0 ? static_cast<float>(std::min(squares / smoothest - 1.0, 1.0)) : 1.0f;
}

}  // namespace

std::vector<double> filled_heights(const ReliefPatches& patches, double spacing,
                                   const LikenessOptions& options) {
  const ReliefPoints& points = patches.points();
  std::vector<ReliefAnchor> unseen;
  double smoothest = 0.0;
  for (const ReliefAnchor& anchor : patches.anchors()) {
    if (!anchor.unseen) continue;
    unseen.push_back(anchor);
    smoothest = std::max(smoothest, patches.squares_around()[anchor.place]);
  }
  if (unseen.empty()) return patches.measured().heights;
  const ReliefValues blend = measured_blend(patches, spacing);
  const ReliefBands bands = surface_bands(patches, blend);
  std::vector<LaidHeights> before(points.size());
  for (std::size_t b = 0; b < kReliefBands; ++b) {
    const std::vector<double> values = blend.evaluate(bands.bands[b]);
    for (std::size_t i = 0; i < values.size(); ++i) {
      before[i].height[b] = static_cast<float>(values[i]);
      before[i].cover[b] = seen_cover(patches.squares_around()[i], smoothest);
    }
  }
  std::vector<LaidHeights> laid = before;
  lay_patches(patches, bands.bands, points, unseen,
              ReliefDonors(patches, patches.anchors(), options.reach, options.fill), options.hash, laid);
  std::vector<double> change(points.size());
  for (std::size_t i = 0; i < change.size(); ++i) change[i] = laid[i].sum() - before[i].sum();
  std::vector<double> heights = blend.solve(change);
  add(patches.measured().heights, heights);
  return heights;
}

}  // namespace astrolith
