// Patches of measured heights, laid one after another over a body of the kind, each where it agrees best with
// those before it (image quilting, Efros and Freeman 2001, on a surface). A seam
// is, for each angle around the middle of a patch, the radius within which the patch is new.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <vector>

#include "synthesis/relief/relief_donors.h"
#include "synthesis/relief/relief_patches.h"

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

// Heights in bands from narrow to wide, cut at .8, 1.6, 3.2, 6.4 and 12.8 edges (standard deviations of
// smoothing), and what is wider.
inline constexpr std::size_t kReliefBands = 5;
using BandHeights = std::array<std::vector<double>, kReliefBands>;
struct ReliefBands {
  BandHeights bands;
  std::vector<double> rest;

  ReliefBands(const ReliefPoints& points, const std::vector<double>& heights, double edge);
};

// What has been laid at a place: the heights of each band, and how far they cover what lies below, 0 to 1.
struct LaidHeights {
  std::array<float, kReliefBands> height{}, cover{};

  double sum() const {
    double all = 0.0;
    for (const float h : height) all += double{h};
    return all;
  }
};

// Lays a patch around each of the anchors, nearest to the first of them first. Of 16 candidates the patch is
// taken whose heights, without the narrowest band, differ least from those laid before; the seam
// (ReliefSeam) parts both. Over the seam each band goes over from one to the other within some of its own
// widths. `bands` are coefficients at the places of `patches` (relief_layer.h), `laid` are values at
// `points`.
void lay_patches(const ReliefPatches& patches, const BandHeights& bands, const ReliefPoints& points,
                 const std::vector<ReliefAnchor>& anchors, const ReliefDonors& donors, std::uint32_t hash,
                 std::vector<LaidHeights>& laid);

}  // namespace astrolith
