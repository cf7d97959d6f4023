#include "synthesis/relief/relief_patches.h"

#include <algorithm>
#include <cmath>

#include "numerics/hash_random.h"
#include "numerics/portable_double.h"
#include "synthesis/body/ground_points.h"

namespace astrolith {
namespace {

// In mean edges of the measured model; the last is a standard deviation of smoothing.
constexpr double kWidestDistance = 16.0, kLeastDistance = 8.0, kLowBand = 2.5;
constexpr std::size_t kEnoughAnchors = 40;
constexpr int kLowExponent = 3;

// The offset from the donor, turned.
Vec3d carried(const PatchPoint& p, const ReliefAnchor& donor, const PatchTurn& turn) {
  return donor.at + (turn.cosine * p.x - turn.sine * p.y) * donor.right +
         (turn.sine * p.x + turn.cosine * p.y) * donor.ahead;
}

}  // namespace

int AnchorSpacing::high_exponent() const {
  const double share = edges / kWidestDistance;
  return std::max(kLowExponent, static_cast<int>(30.0 * share * share + 0.5));
}

PatchTurn turn_of(std::uint32_t hash) {
  for (;; hash = hash_append(hash, 2)) {
    const double x = 2.0 * double{unit_float(hash_append(hash, 0))} - 1.0,
                 y = 2.0 * double{unit_float(hash_append(hash, 1))} - 1.0, squared = x * x + y * y;
    if (squared <= 1.0 && squared > 1e-4) return {x / std::sqrt(squared), y / std::sqrt(squared)};
  }
}

double wide_weight(const PatchPoint& p) {
  return portable::whole_power(p.near, kLowExponent) * (p.facing * p.facing);
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
  anchors_ = relief_anchors(points_, high_, apart_.distance(), apart_.radius());
  if (anchors_.size() >= kEnoughAnchors) return;
  const double share = std::sqrt(static_cast<double>(anchors_.size()) / static_cast<double>(kEnoughAnchors));
  apart_.edges = std::max(kLeastDistance, share * kWidestDistance);
  anchors_ = relief_anchors(points_, high_, apart_.distance(), apart_.radius());
}

std::vector<PatchHeight> ReliefPatches::heights_at(const std::vector<PatchPoint>& points,
                                                   const ReliefAnchor& donor, const PatchTurn& turn) const {
  std::vector<PatchHeight> patch;
  std::vector<Vec3d> at;
  const int high_exponent = apart_.high_exponent();
  for (const PatchPoint& p : points) {
    const double facing = p.facing * p.facing;
    patch.push_back(
        {p.number, wide_weight(p), portable::whole_power(p.near, high_exponent) * facing, 0.0, 0.0});
    at.push_back(carried(p, donor, turn));
  }
  read(at, patch);
  return patch;
}

// Reads the heights where the points project to.
void ReliefPatches::read(const std::vector<Vec3d>& at, std::vector<PatchHeight>& patch) const {
  constexpr int kProjections = 4;
  if (at.empty()) return;
  GroundPoints feet(at);
  const BodyGround& ground = measured_.ground;
  for (int i = 0; i < kProjections; ++i) {
    evaluate(ground, feet);
    project(ground, feet);
  }
  evaluate(ground, feet);
  std::vector<std::uint32_t> places;
  std::vector<float> shares;
  for (std::size_t i = 0; i < patch.size(); ++i) {
    places.clear(), shares.clear();
    if (std::fabs(double{feet.distance[i]}) <= most_missed_) shares_.add(feet.at(i), places, shares);
    if (places.empty()) patch[i].low_weight = patch[i].high_weight = 0.0;
    for (std::size_t k = 0; k < places.size(); ++k) {
      patch[i].low += double{shares[k]} * low_[places[k]];
      patch[i].high += double{shares[k]} * high_[places[k]];
    }
  }
}

}  // namespace astrolith
