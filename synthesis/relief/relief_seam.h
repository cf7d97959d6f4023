// The seam along which a patch of heights is laid over older ones: for each angle around the patch's middle
// the radius within which the patch is new.
#pragma once

#include <array>
#include <cstddef>
#include <vector>

namespace astrolith {

// A point of a patch, in radii of the patch.
struct SeamPoint {
  double x, y;
  bool laid;        // whether it has an older height
  double mismatch;  // squared difference of both heights there
};

// New heights are kept within .3 radii, older ones beyond .93; ground without older heights is new. Among the
// seams that meet each angle once, it is the one with the least integral of the mismatch.
class ReliefSeam {
 public:
  static constexpr std::size_t kAngles = 48;

  explicit ReliefSeam(const std::vector<SeamPoint>& points);

  // The seam smoothed along its length with a standard deviation of about `width` radii.
  ReliefSeam smoothed(double width) const;

  // How far the seam lies beyond a point, in radii; negative where the point lies beyond it.
  double margin(double x, double y) const;

 private:
  std::array<double, kAngles> radii_;
};

}  // namespace astrolith
