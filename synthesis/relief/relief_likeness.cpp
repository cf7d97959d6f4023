#include "synthesis/relief/relief_likeness.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "numerics/errors.h"
#include "numerics/hash_random.h"
#include "numerics/parallel_for.h"
#include "numerics/portable_double.h"
#include "synthesis/body/ground_points.h"
#include "synthesis/relief/relief_anchors.h"
#include "synthesis/relief/relief_shares.h"
#include "synthesis/relief/relief_values.h"

namespace astrolith {
namespace {

// In mean edges of the measured model; the last are standard deviations of smoothing.
constexpr double kWidestDistance = 16.0, kLeastDistance = 8.0, kLowBand = 2.5,
                 kEqualBands[] = {0.7, 1.4, 2.8};
constexpr std::size_t kEnoughAnchors = 40, kFewestAnchors = 10;
constexpr int kLowExponent = 3;

// How far anchors lie apart, and what follows from it.
struct AnchorSpacing {
  double edge;   // length units
  double edges;  // between anchors

  double distance() const { return edges * edge; }
  double radius() const { return 1.5 * distance(); }  // of patches
  // Patches change from one to the next within some 4 edges.
  int high_exponent() const {
    const double share = edges / kWidestDistance;
    return std::max(kLowExponent, static_cast<int>(30.0 * share * share + 0.5));
  }
};

// Heights in two bands, as coefficients at the places.
struct ReliefBands {
  std::vector<double> low, high;
};

ReliefBands split_bands(const ReliefPoints& points, const std::vector<double>& heights, double edge) {
  ReliefBands bands{smoothed_heights(points, heights, kLowBand * edge), heights};
  for (std::size_t i = 0; i < heights.size(); ++i) bands.high[i] -= bands.low[i];
  return bands;
}

// A cosine and a sine that belong together, from a hash: uniform over all angles.
struct PatchTurn {
  double cosine, sine;
};
PatchTurn turn_of(std::uint32_t hash) {
  for (;; hash = hash_append(hash, 2)) {
    const double x = 2.0 * double{unit_float(hash_append(hash, 0))} - 1.0,
                 y = 2.0 * double{unit_float(hash_append(hash, 1))} - 1.0, squared = x * x + y * y;
    if (squared <= 1.0 && squared > 1e-4) return {x / std::sqrt(squared), y / std::sqrt(squared)};
  }
}

// What an anchor's patch gives to a place.
struct PatchHeight {
  std::uint32_t place;
  double low_weight, high_weight;
  double low, high;
};

// Patches of what was measured, laid around anchors.
class Patches {
 public:
  Patches(const BodyGround& ground, const ReliefShares& shares, const ReliefBands& bands,
          const AnchorSpacing& spacing, double most_missed)
      : ground_(ground),
        shares_(shares),
        bands_(bands),
        radius_(spacing.radius()),
        high_exponent_(spacing.high_exponent()),
        most_missed_(most_missed) {}

  // What the donor's patch gives to the points around an anchor.
  std::vector<PatchHeight> heights_around(const ReliefPoints& points, const ReliefAnchor& anchor,
                                          const ReliefAnchor& donor, const PatchTurn& turn) const {
    std::vector<PatchHeight> patch;
    std::vector<Vec3d> at;
    points.for_each_near(anchor.at, anchor.up, radius_, [&](std::uint32_t k, double squared, double facing) {
      const double near = 1.0 - squared / (radius_ * radius_);
      const double soft = portable::whole_power(near, kLowExponent) * facing * facing;
      patch.push_back({k, soft, portable::whole_power(near, high_exponent_) * facing * facing, 0.0, 0.0});
      at.push_back(carried(points.at(k) - anchor.at, anchor, donor, turn));
    });
    read(at, patch);
    return patch;
  }

 private:
  // The offset in the anchor's tangent plane, as long as the chord, from the donor and turned.
  static Vec3d carried(const Vec3d& offset, const ReliefAnchor& anchor, const ReliefAnchor& donor,
                       const PatchTurn& turn) {
    const double x = dot(offset, anchor.right), y = dot(offset, anchor.ahead);
    const double across = std::sqrt(x * x + y * y), scale = across > 0.0 ? norm(offset) / across : 0.0;
    return donor.at + scale * (turn.cosine * x - turn.sine * y) * donor.right +
           scale * (turn.sine * x + turn.cosine * y) * donor.ahead;
  }

  // Reads the heights where the points project to. A patch has no weight where they miss the surface.
  void read(const std::vector<Vec3d>& at, std::vector<PatchHeight>& patch) const {
    constexpr int kProjections = 4;
    if (at.empty()) return;
    GroundPoints feet(at);
    for (int i = 0; i < kProjections; ++i) {
      evaluate(ground_, feet);
      project(ground_, feet);
    }
    evaluate(ground_, feet);
    std::vector<std::uint32_t> places;
    std::vector<float> shares;
    for (std::size_t i = 0; i < patch.size(); ++i) {
      places.clear(), shares.clear();
      if (std::fabs(double{feet.distance[i]}) <= most_missed_) shares_.add(feet.at(i), places, shares);
      if (places.empty()) patch[i].low_weight = patch[i].high_weight = 0.0;
      for (std::size_t k = 0; k < places.size(); ++k) {
        patch[i].low += double{shares[k]} * bands_.low[places[k]];
        patch[i].high += double{shares[k]} * bands_.high[places[k]];
      }
    }
  }

  const BodyGround& ground_;
  const ReliefShares& shares_;
  const ReliefBands& bands_;
  double radius_;
  int high_exponent_;
  double most_missed_;
};

// Sums over the patches of a place.
struct PatchSums {
  double low_weight = 0.0, low = 0.0, high_weight = 0.0, high_squares = 0.0, high = 0.0;

  void add(const PatchHeight& p) {
    low_weight += p.low_weight;
    low += p.low_weight * p.low;
    high_weight += p.high_weight;
    high_squares += p.high_weight * p.high_weight;
    high += p.high_weight * p.high;
  }
  // The height, or `otherwise` where no patch has a weight.
  double height(double otherwise) const {
    if (!(low_weight > 0.0 && high_squares > 0.0)) return otherwise;
    return low / low_weight + high / std::sqrt(high_squares);
  }
};

// Anchors of a body, and for each the anchor of the measured body that gives its patch.
struct DrawnAnchors {
  std::vector<ReliefAnchor> anchors, donors;
};

DrawnAnchors draw_anchors(std::vector<ReliefAnchor> anchors, const std::vector<ReliefAnchor>& measured,
                          const LikenessOptions& options) {
  DrawnAnchors drawn{std::move(anchors), {}};
  for (const std::uint32_t donor :
       relief_donors(drawn.anchors, measured, options.reach, hash_append(options.hash, 1))) {
    drawn.donors.push_back(measured[donor]);
  }
  return drawn;
}

// The heights at the points; where no patch has a weight, those of `otherwise`.
std::vector<double> blended(const Patches& patches, const ReliefPoints& points, const DrawnAnchors& drawn,
                            const std::vector<double>& otherwise, std::uint32_t hash) {
  std::vector<std::vector<PatchHeight>> of_anchor(drawn.anchors.size());
  parallel_for(0, static_cast<std::int64_t>(of_anchor.size()), [&](std::int64_t number) {
    const auto a = static_cast<std::size_t>(number);
    const PatchTurn turn = turn_of(hash_append(hash_append(hash, 2), static_cast<std::uint32_t>(a)));
    of_anchor[a] = patches.heights_around(points, drawn.anchors[a], drawn.donors[a], turn);
  });
  std::vector<PatchSums> sums(points.size());
  for (const std::vector<PatchHeight>& patch : of_anchor) {
    for (const PatchHeight& p : patch) sums[p.place].add(p);
  }
  std::vector<double> heights(points.size());
  for (std::size_t i = 0; i < heights.size(); ++i) heights[i] = sums[i].height(otherwise[i]);
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
// few rough places.
double typical_rms(const ReliefPoints& points, const std::vector<double>& heights, double edge) {
  constexpr double kAround = 3.0, kLeast = 1e-12;  // edges; of the largest square
  std::vector<double> squares(heights.size());
  for (std::size_t i = 0; i < heights.size(); ++i) squares[i] = heights[i] * heights[i];
  const double largest = *std::max_element(squares.begin(), squares.end());
  if (!(largest > 0.0)) return 0.0;
  double total = 0.0, logarithms = 0.0;
  const std::vector<double> around = smoothed_heights(points, squares, kAround * edge);
  for (std::size_t i = 0; i < around.size(); ++i) {
    total += points.weight(i);
    logarithms += points.weight(i) * portable::log(std::max(around[i] / largest, kLeast));
  }
  return std::sqrt(largest * portable::exp(logarithms / total));
}

// Heights whose bands are as strong as those that were measured: blends and resampling take from each a share
// of its own.
std::vector<double> equalized(const ReliefPoints& points, const std::vector<double>& heights,
                              const ReliefPoints& of_measured, const std::vector<double>& measured,
                              double edge) {
  constexpr double kMostGain = 2.0;  // of all bands but the finest, which would be noise
  const std::vector<std::vector<double>> bands = bands_of(points, heights, edge),
                                         wanted = bands_of(of_measured, measured, edge);
  std::vector<double> sum = bands.back();
  for (std::size_t band = 0; band + 1 < bands.size(); ++band) {
    const double has = typical_rms(points, bands[band], edge),
                 wants = typical_rms(of_measured, wanted[band], edge);
    const double most = band == 0 ? 1.0 : kMostGain;
    const double gain = has > 0.0 ? std::min(wants / has, most) : 1.0;
    for (std::size_t i = 0; i < sum.size(); ++i) sum[i] += gain * bands[band][i];
  }
  return sum;
}

}  // namespace

std::vector<double> like_heights(const std::vector<ReliefPlace>& places, const MeasuredRelief& measured,
                                 bool foreign, double spacing, const LikenessOptions& options,
                                 const std::string& where) {
  const ReliefPoints of_measured(measured.places, spacing);
  const ReliefShares shares(measured.places, spacing);
  const ReliefBands bands = split_bands(of_measured, measured.heights, options.edge);
  AnchorSpacing apart{options.edge, kWidestDistance};
  std::vector<ReliefAnchor> anchors =
      relief_anchors(of_measured, bands.high, apart.distance(), apart.radius());
  if (anchors.size() < kEnoughAnchors) {
    const double share = std::sqrt(static_cast<double>(anchors.size()) / static_cast<double>(kEnoughAnchors));
    apart.edges = std::max(kLeastDistance, share * kWidestDistance);
    anchors = relief_anchors(of_measured, bands.high, apart.distance(), apart.radius());
  }
  if (anchors.size() < kFewestAnchors) {
    throw InputError(where + ": the body has room for " + std::to_string(anchors.size()) +
                     " patches of its relief, and a body of its kind needs " +
                     std::to_string(kFewestAnchors) +
                     "; keep the arrangement measured, or fit a finer model");
  }
  const Patches patches(measured.ground, shares, bands, apart, 0.25 * spacing);
  if (places.empty()) return {};  // a base that is smaller than the spacing
  const ReliefPoints points(places, spacing);
  const ReliefValues blend(points, ReliefShares(places, spacing));
  const DrawnAnchors drawn =
      draw_anchors(foreign ? relief_anchors(points, {}, apart.distance(), 0.0) : anchors, anchors, options);
  const std::vector<double> otherwise =
      foreign ? std::vector<double>(places.size()) : blend.values_of(measured.heights);
  const std::vector<double> values = blended(patches, points, drawn, otherwise, options.hash);
  return equalized(points, blend.coefficients_of(values), of_measured, measured.heights, options.edge);
}

}  // namespace astrolith
