// Points of the surface around which patches of a relief are cut. They follow from the places alone.
#pragma once

#include <cstdint>
#include <vector>

#include "synthesis/relief/relief_smoothing.h"

namespace astrolith {

// A point of the surface with a frame there: right, ahead and up are orthonormal, and up is the normal.
struct ReliefAnchor {
  Vec3d at;  // length units
  Vec3d right, ahead, up;
  double rms = 0.0;        // of the heights around it, length units
  double roughness = 0.0;  // rank of rms among all anchors, 0 to 1
  bool unseen = false;     // so smooth that no camera saw the ground
};

// Anchors at Poisson disks: no two that face the same side are closer than `distance`, and every place has
// one within it. Roughness is that of `heights` within `radius`; it is 0 without heights. Ground is
// unseen where it is below a seventh of the third quartile, at 3 % of the anchors at least. Lengths in
// length units.
std::vector<ReliefAnchor> relief_anchors(const ReliefPoints& points, const std::vector<double>& heights,
                                         double distance, double radius);

// The number of the measured anchor that gives each anchor its patch. Boxes around both lists are laid on
// each other, and the measured anchor nearest to a place is its own, which gives nothing. A donor comes from
// within `reach` of the place (a share of the diagonal of the measured box) if there is any there, is as
// rough as the place's own anchor, and is otherwise drawn by a hash. With `fill` an unseen place gets any
// patch of ground seen all around, by the hash alone, and unseen ground gives none. Expects two measured
// anchors at least.
std::vector<std::uint32_t> relief_donors(const std::vector<ReliefAnchor>& anchors,
                                         const std::vector<ReliefAnchor>& measured, double reach, bool fill,
                                         std::uint32_t hash);

}  // namespace astrolith
