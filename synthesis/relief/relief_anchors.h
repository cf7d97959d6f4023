// Points of the surface around which patches of a relief are cut. They follow from the places alone.
#pragma once

#include <cstdint>
#include <vector>

#include "synthesis/relief/relief_smoothing.h"

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

}  // namespace astrolith
