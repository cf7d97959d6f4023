// Patches of a measured relief: the heights around one anchor, laid around another point and turned.
// The anchors are points of the surface that follow from the places alone.
#pragma once

#include <cstdint>
#include <vector>

#include "synthesis/body/body_ground.h"
#include "synthesis/relief/relief_places.h"
#include "synthesis/relief/relief_smoothing.h"
#include "synthesis/relief/relief_tiles.h"

namespace astrolith {

// A point of the surface with a frame there: right, ahead and up are orthonormal, and up is the normal.
struct ReliefAnchor {
  std::uint32_t place;  // its number
  Vec3d at;             // length units
  Vec3d right, ahead, up;
  double rms = 0.0;        // of the heights around it, length units
  double roughness = 0.0;  // rank of rms among all anchors, 0 to 1
  bool unseen = false;     // so smooth that no camera saw the ground
};

// Anchors at Poisson disks: no two that face the same side are closer than `distance` (length units), and
// every place has one within it. They have no roughness yet.
std::vector<ReliefAnchor> relief_anchors(const ReliefPoints& points, double distance);

// Sets the roughness of all anchors to that of their places, given the mean squares of heights around all
// places. Ground is unseen where it is below a seventh of the third quartile, at 3 % of the anchors at least.
void rank_roughness(const std::vector<double>& squares, std::vector<ReliefAnchor>& anchors);

// The anchor at a place, without its roughness.
ReliefAnchor anchor_at(const ReliefPoints& points, std::uint32_t place);

// Heights at the places of a body.
struct MeasuredRelief {
  BodyGround ground;
  const std::vector<ReliefPlace>& places;
  const ReliefTiles& tiles;            // of the places
  const std::vector<double>& heights;  // coefficients of the blend (relief_layer.h), length units
};

// How far anchors lie apart, and what follows from it: 16 edges, or on small models as near as leaves forty
// anchors, but 8 at least.
struct AnchorSpacing {
  double edge;   // mean edge of the measured model, length units
  double edges;  // between anchors

  double distance() const { return edges * edge; }
  double radius() const { return 1.5 * distance(); }  // of patches
  // The exponent of the weights of narrow heights: patches change from one to the next within some 4 edges.
  int high_exponent() const;
};

// A cosine and a sine that belong together, from a hash: uniform over all angles.
struct PatchTurn {
  double cosine, sine;
};
PatchTurn hash_to_turn(std::uint32_t hash);

// A point near an anchor: its number, its offset in the anchor's tangent plane, as long as the chord, in
// length units, and the weight (1 - d^2 / R^2), times the cosine between the normals squared where there are
// two.
struct PatchPoint {
  std::uint32_t number;
  double x, y;
  double near, facing;
};

// What points take from the places of a relief (relief_tiles.h): nothing where they miss the surface.
struct ReliefRows {
  std::vector<std::size_t> first;  // (points + 1) of the two lists
  std::vector<std::uint32_t> places;
  std::vector<float> shares;

  bool any(std::size_t i) const { return first[i] < first[i + 1]; }
  double of(const std::vector<double>& heights, std::size_t i) const {
    double sum = 0.0;
    for (std::size_t k = first[i]; k < first[i + 1]; ++k) sum += double{shares[k]} * heights[places[k]];
    return sum;
  }
};

// What a patch gives to a point, in two bands: heights smoothed by 2.5 edges, and the rest.
struct PatchHeight {
  std::uint32_t number;
  double low_weight, high_weight;
  double low, high;
};

// The wide band: heights smoothed by 2.5 edges.
std::vector<double> wide_heights(const ReliefPoints& points, const std::vector<double>& heights, double edge);

class ReliefPatches {
 public:
  // The places, tiles and heights must outlive this.
  ReliefPatches(const MeasuredRelief& measured, double spacing, double edge);

  const MeasuredRelief& measured() const { return measured_; }
  const ReliefPoints& points() const { return points_; }
  const AnchorSpacing& anchor_spacing() const { return apart_; }
  const std::vector<ReliefAnchor>& anchors() const { return anchors_; }
  // The mean squares of narrow heights around all places, within a patch.
  const std::vector<double>& squares_around() const { return squares_around_; }

  // What the points take of the places where they lie around a donor: on the surface, as far from it.
  ReliefRows rows_at(const std::vector<PatchPoint>& points, const ReliefAnchor& donor,
                     const PatchTurn& turn) const;

  // What the donor's patch gives to points. A patch has no weight where its points miss the surface.
  std::vector<PatchHeight> heights_at(const std::vector<PatchPoint>& points, const ReliefAnchor& donor,
                                      const PatchTurn& turn) const;

 private:
  MeasuredRelief measured_;
  ReliefPoints points_;
  ReliefShares shares_;
  std::vector<double> low_, high_;  // bands of the coefficients
  double most_missed_;              // length units
  AnchorSpacing apart_;
  std::vector<double> squares_around_;
  std::vector<ReliefAnchor> anchors_;
};

// Sums over the patches of a point. Wide heights are means, since they are wide; narrow ones are divided by
// the root of the sum of the squared weights, so that they keep their variance.
struct PatchSums {
  double low_weight = 0.0, low = 0.0, high_squares = 0.0, high = 0.0;

  void add(const PatchHeight& p) {
    low_weight += p.low_weight;
    low += p.low_weight * p.low;
    high_squares += p.high_weight * p.high_weight;
    high += p.high_weight * p.high;
  }
  bool any() const { return low_weight > 0.0 && high_squares > 0.0; }
  // Expects any().
  double height() const;
};

}  // namespace astrolith
