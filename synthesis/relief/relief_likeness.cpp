#include "synthesis/relief/relief_likeness.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "numerics/errors.h"
#include "numerics/hash_random.h"
#include "numerics/parallel_for.h"
#include "synthesis/body/ground_points.h"
#include "synthesis/relief/relief_anchors.h"
#include "synthesis/relief/relief_shares.h"

namespace astrolith {
namespace {

// In mean edges of the measured model.
constexpr double kAnchorDistance = 16.0, kPatchRadius = 24.0, kLowBand = 2.5, kSharpened = 0.75;
constexpr std::size_t kFewestAnchors = 10;

// Heights in two bands, as coefficients at the places.
struct ReliefBands {
  std::vector<double> low, high;
};

ReliefBands split_bands(const ReliefPoints& points, const std::vector<double>& heights,
                        const LikenessOptions& options) {
  ReliefBands bands{smoothed_heights(points, heights, kLowBand * options.edge), heights};
  for (std::size_t i = 0; i < heights.size(); ++i) bands.high[i] -= bands.low[i];
  if (options.sharpen > 0.0) {
    const std::vector<double> blurred = smoothed_heights(points, bands.high, kSharpened * options.edge);
    for (std::size_t i = 0; i < heights.size(); ++i) {
      bands.high[i] += options.sharpen * (bands.high[i] - blurred[i]);
    }
  }
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
  Patches(const BodyGround& ground, const ReliefShares& shares, const ReliefBands& bands, double radius,
          double most_missed)
      : ground_(ground), shares_(shares), bands_(bands), radius_(radius), most_missed_(most_missed) {}

  // What the donor's patch gives to the points around an anchor.
  std::vector<PatchHeight> heights_around(const ReliefPoints& points, const ReliefAnchor& anchor,
                                          const ReliefAnchor& donor, const PatchTurn& turn) const {
    std::vector<PatchHeight> patch;
    std::vector<Vec3d> at;
    points.for_each_near(anchor.at, anchor.up, radius_, [&](std::uint32_t k, double squared, double facing) {
      const double near = 1.0 - squared / (radius_ * radius_);
      const double soft = near * near * facing * facing;
      const double near_4 = near * near * near * near, near_12 = near_4 * near_4 * near_4;
      patch.push_back({k, soft, soft * near_12 * near_12 * near_4, 0.0, 0.0});
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
  double radius_, most_missed_;
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
                            std::vector<double> otherwise, std::uint32_t hash) {
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
  std::vector<double> heights = std::move(otherwise);
  for (std::size_t i = 0; i < heights.size(); ++i) heights[i] = sums[i].height(heights[i]);
  return heights;
}

// Coefficients whose blend has nearly these values at the places, by damped iterations. What lies at the
// finest waves of the lattice is left to the spline.
std::vector<double> coefficients_of(const std::vector<double>& values, const ReliefPoints& points,
                                    const ReliefShares& shares) {
  constexpr int kIterations = 6;
  constexpr double kDamping = 1.3;
  struct Row {
    std::vector<std::uint32_t> places;
    std::vector<float> shares;
  };
  const auto n = static_cast<std::int64_t>(values.size());
  std::vector<Row> rows(values.size());
  parallel_for(
      0, n,
      [&](std::int64_t i) {
        Row& row = rows[static_cast<std::size_t>(i)];
        shares.add(to_float(points.at(static_cast<std::size_t>(i))), row.places, row.shares);
      },
      256);
  std::vector<double> coefficients = values, next(values.size());
  for (int pass = 0; pass < kIterations; ++pass) {
    parallel_for(
        0, n,
        [&](std::int64_t number) {
          const auto i = static_cast<std::size_t>(number);
          double sum = 0.0;
          for (std::size_t k = 0; k < rows[i].places.size(); ++k) {
            sum += double{rows[i].shares[k]} * coefficients[rows[i].places[k]];
          }
          next[i] = coefficients[i] + (rows[i].places.empty() ? 0.0 : kDamping * (values[i] - sum));
        },
        256);
    coefficients.swap(next);
  }
  return coefficients;
}

}  // namespace

std::vector<double> like_heights(const std::vector<ReliefPlace>& places, const MeasuredRelief& measured,
                                 bool foreign, double spacing, const LikenessOptions& options,
                                 const std::string& where) {
  const ReliefPoints of_measured(measured.places, spacing);
  const ReliefShares shares(measured.places, spacing);
  const ReliefBands bands = split_bands(of_measured, measured.heights, options);
  const std::vector<ReliefAnchor> anchors =
      relief_anchors(of_measured, bands.high, kAnchorDistance * options.edge, kPatchRadius * options.edge);
  if (anchors.size() < kFewestAnchors) {
    throw InputError(where + ": the body has room for " + std::to_string(anchors.size()) +
                     " patches of its relief, and a body of its kind needs " +
                     std::to_string(kFewestAnchors) +
                     "; keep the arrangement measured, or fit a finer model");
  }
  const Patches patches(measured.ground, shares, bands, kPatchRadius * options.edge, 0.25 * spacing);
  if (!foreign) {
    const DrawnAnchors drawn = draw_anchors(anchors, anchors, options);
    return coefficients_of(blended(patches, of_measured, drawn, measured.heights, options.hash), of_measured,
                           shares);
  }
  const ReliefPoints points(places, spacing);
  const DrawnAnchors drawn =
      draw_anchors(relief_anchors(points, {}, kAnchorDistance * options.edge, 0.0), anchors, options);
  return coefficients_of(blended(patches, points, drawn, std::vector<double>(places.size()), options.hash),
                         points, ReliefShares(places, spacing));
}

}  // namespace astrolith
