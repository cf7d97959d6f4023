#include "synthesis/relief/relief_patches.h"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <utility>

#include "numerics/hash_random.h"
#include "numerics/portable_double.h"
#include "numerics/tangent_frame.h"
#include "synthesis/body/ground_points.h"

namespace astrolith {
namespace {

// The numbers of the places in an order that looks random.
std::vector<std::uint32_t> hashed_order(std::size_t n) {
  constexpr std::uint32_t kOrder = 0x51ed270bu;
  std::vector<std::pair<std::uint32_t, std::uint32_t>> hashed(n);
  for (std::uint32_t i = 0; i < n; ++i) hashed[i] = {hash_append(kOrder, i), i};
  std::sort(hashed.begin(), hashed.end());
  std::vector<std::uint32_t> order(n);
  for (std::size_t k = 0; k < n; ++k) order[k] = hashed[k].second;
  return order;
}

// `order` has the numbers of the anchors, the smoothest first.
void mark_unseen(const std::vector<std::size_t>& order, std::vector<ReliefAnchor>& anchors) {
  constexpr double kSmooth = 1.0 / 7.0, kLeastShare = 0.03;
  const double limit = kSmooth * anchors[order[order.size() * 3 / 4]].rms;
  std::size_t count = 0;
  while (count < order.size() && anchors[order[count]].rms < limit) ++count;
  if (static_cast<double>(count) < kLeastShare * static_cast<double>(order.size())) return;
  for (std::size_t i = 0; i < count; ++i) anchors[order[i]].unseen = true;
}

// In mean edges of the measured model; the last is a standard deviation of smoothing.
constexpr double kWidestDistance = 16.0, kLeastDistance = 8.0, kLowBand = 2.5;
constexpr std::size_t kEnoughAnchors = 40;
constexpr int kLowExponent = 3;

// The offset of a point from an anchor, laid at another one and turned.
Vec3d carried(const PatchPoint& p, const ReliefAnchor& donor, const PatchTurn& turn) {
  return donor.at + (turn.cosine * p.x - turn.sine * p.y) * donor.right +
         (turn.sine * p.x + turn.cosine * p.y) * donor.ahead;
}

// Moves each foot along the line from the middle, so that it is as far from it as its point from the anchor.
void keep_distances(const std::vector<PatchPoint>& points, const Vec3d& middle, GroundPoints& feet) {
  for (std::size_t i = 0; i < points.size(); ++i) {
    const Vec3d offset = Vec3d{double{feet.x[i]}, double{feet.y[i]}, double{feet.z[i]}} - middle;
    const double length = norm(offset);
    if (!(length > 0.0)) continue;
    const double wanted = std::sqrt(points[i].x * points[i].x + points[i].y * points[i].y);
    const Vec3f moved = to_float(middle + (wanted / length) * offset);
    feet.x[i] = moved.x, feet.y[i] = moved.y, feet.z[i] = moved.z;
  }
}

}  // namespace

ReliefAnchor anchor_at(const ReliefPoints& points, std::uint32_t place) {
  const Vec3d up = normalized(points.normal(place));
  const auto [right, ahead] = crossed_tangents(up);
  return {place, points.at(place), right, ahead, up};
}

std::vector<ReliefAnchor> relief_anchors(const ReliefPoints& points, double distance) {
  std::vector<ReliefAnchor> anchors;
  std::vector<bool> covered(points.size(), false);
  for (const std::uint32_t i : hashed_order(points.size())) {
    if (covered[i]) continue;
    covered[i] = true;
    anchors.push_back(anchor_at(points, i));
    points.for_each_near(points.at(i), points.normal(i), distance,
                         [&](std::uint32_t k, double, double) { covered[k] = true; });
  }
  return anchors;
}

void rank_roughness(const std::vector<double>& squares, std::vector<ReliefAnchor>& anchors) {
  for (ReliefAnchor& anchor : anchors) anchor.rms = std::sqrt(squares[anchor.place]);
  std::vector<std::size_t> order(anchors.size());
  std::iota(order.begin(), order.end(), std::size_t{0});
  std::stable_sort(order.begin(), order.end(),
                   [&](std::size_t a, std::size_t b) { return anchors[a].rms < anchors[b].rms; });
  for (std::size_t rank = 0; rank < order.size(); ++rank) {
    anchors[order[rank]].roughness = static_cast<double>(rank) / static_cast<double>(order.size());
  }
  mark_unseen(order, anchors);
}

int AnchorSpacing::high_exponent() const {
  const double share = edges / kWidestDistance;
  return std::max(kLowExponent, static_cast<int>(30.0 * share * share + 0.5));
}

PatchTurn hash_to_turn(std::uint32_t hash) {
  for (;; hash = hash_append(hash, 2)) {
    const double x = 2.0 * double{unit_float(hash_append(hash, 0))} - 1.0,
                 y = 2.0 * double{unit_float(hash_append(hash, 1))} - 1.0, squared = x * x + y * y;
    if (squared <= 1.0 && squared > 1e-4) return {x / std::sqrt(squared), y / std::sqrt(squared)};
  }
}

double PatchSums::height() const { return low / low_weight + high / std::sqrt(high_squares); }

std::vector<double> wide_heights(const ReliefPoints& points, const std::vector<double>& heights,
                                 double edge) {
  return smoothed_heights(points, heights, kLowBand * edge);
}

ReliefPatches::ReliefPatches(const MeasuredRelief& measured, double spacing, double edge)
    : measured_(measured),
      points_(measured.places, spacing),
      shares_(measured.places, measured.tiles, spacing),
      low_(wide_heights(points_, measured.heights, edge)),
      high_(measured.heights),
      most_missed_(0.25 * spacing),
      apart_{edge, kWidestDistance} {
  for (std::size_t i = 0; i < high_.size(); ++i) high_[i] -= low_[i];
  anchors_ = relief_anchors(points_, apart_.distance());
  if (anchors_.size() < kEnoughAnchors) {
    const double share =
        std::sqrt(static_cast<double>(anchors_.size()) / static_cast<double>(kEnoughAnchors));
    apart_.edges = std::max(kLeastDistance, share * kWidestDistance);
    anchors_ = relief_anchors(points_, apart_.distance());
  }
  squares_around_ = high_;
  for (double& square : squares_around_) square *= square;
  squares_around_ = smoothed_heights(points_, squares_around_, apart_.radius() / std::sqrt(8.0));
  rank_roughness(squares_around_, anchors_);
}

std::vector<PatchHeight> ReliefPatches::heights_at(const std::vector<PatchPoint>& points,
                                                   const ReliefAnchor& donor, const PatchTurn& turn) const {
  const ReliefRows rows = rows_at(points, donor, turn);
  std::vector<PatchHeight> patch;
  for (std::size_t i = 0; i < points.size(); ++i) {
    const PatchPoint& p = points[i];
    const double facing = rows.any(i) ? p.facing * p.facing : 0.0;
    patch.push_back({p.number, portable::whole_power(p.near, kLowExponent) * facing,
                     portable::whole_power(p.near, apart_.high_exponent()) * facing, rows.of(low_, i),
                     rows.of(high_, i)});
  }
  return patch;
}

ReliefRows ReliefPatches::rows_at(const std::vector<PatchPoint>& points, const ReliefAnchor& donor,
                                  const PatchTurn& turn) const {
  constexpr int kProjections = 4;
  ReliefRows rows{{0}, {}, {}};
  if (points.empty()) return rows;
  std::vector<Vec3d> at;
  for (const PatchPoint& p : points) at.push_back(carried(p, donor, turn));
  GroundPoints feet(at);
  const BodyGround& ground = measured_.ground;
  for (int i = 0; i < kProjections; ++i) {
    if (i > 0) keep_distances(points, donor.at, feet);
    evaluate(ground, feet);
    project(ground, feet);
  }
  evaluate(ground, feet);
  for (std::size_t i = 0; i < at.size(); ++i) {
    if (std::fabs(double{feet.distance[i]}) <= most_missed_)
      shares_.add(feet.at(i), rows.places, rows.shares);
    rows.first.push_back(rows.places.size());
  }
  return rows;
}

}  // namespace astrolith
