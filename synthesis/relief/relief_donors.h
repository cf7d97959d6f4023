// Places of a measured body whose surroundings can be laid at places of a body of its kind.
#pragma once

#include <cstdint>
#include <vector>

#include "numerics/vec3.h"
#include "synthesis/relief/relief_patches.h"

namespace astrolith {

// A patch that could be laid around an anchor: its middle on the measured body, and an angle.
struct ReliefDonor {
  ReliefAnchor middle;
  PatchTurn turn;
};

// Boxes around both lists of anchors are laid on each other, so that a place of one body has its own place on
// the measured body. Donors come from within `reach` of it (a share of the diagonal of the measured box), but
// not from within the distance of two anchors, and are as rough to a tenth of all ranks. With `fill` unseen
// ground (relief_patches.h) gets patches from anywhere, and gives none.
class ReliefDonors {
 public:
  // `patches` must outlive this.
  ReliefDonors(const ReliefPatches& patches, const std::vector<ReliefAnchor>& anchors, double reach,
               bool fill);

  // `count` candidates for an anchor, drawn by a hash. Where few are within the limits, those nearest to
  // them.
  std::vector<ReliefDonor> candidates(const ReliefAnchor& anchor, std::size_t count,
                                      std::uint32_t hash) const;

 private:
  const ReliefAnchor& own_anchor(const Vec3d& own) const;
  double beyond_limits(std::uint32_t place, const Vec3d& own, const ReliefAnchor& near_own) const;

  const ReliefPatches& patches_;
  Box from_, to_;
  double reach_;               // length units
  std::vector<Vec3d> unseen_;  // middles of unseen ground, with `fill`
  std::vector<double> ranks_;  // of the roughness at places, 0 to 1
};

}  // namespace astrolith
