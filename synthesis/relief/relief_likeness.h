// Heights like the measured ones, in other places: patches of them are drawn for other anchors, turned and
// blended. A body of the kind then has whole boulders and craters where the measured one has others.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "synthesis/relief/relief_patches.h"

namespace astrolith {

struct LikenessOptions {
  double reach = 0.3;  // how far donors are looked for at first, as a share of the body's diagonal
  bool fill = false;   // whether unseen ground (relief_anchors.h) gets patches of seen ground
  std::uint32_t hash = 0;
};

// New heights at places of a body with their tiles, from those measured on it or, with `foreign`, on another
// one.
//
// A place at the offset o from an anchor (AnchorSpacing), in the tangent frame and as long as the chord, gets
// the height at the offset o from the anchor's donor, turned by an angle of the hash and projected on the
// surface. Patches are blended as PatchSums does, with weights (1 - d^2 / R^2)^n of n = 3 for wide heights
// and up to 30 for narrow ones. Bands of the result, cut at .7, 1.4 and 2.8 edges, become as strong as those
// that were measured, by the geometric mean over the body of the root mean square around a place. Throws
// InputError, which begins with `where`, where fewer than ten anchors have been measured.
std::vector<double> like_heights(const std::vector<ReliefPlace>& places, const ReliefTiles& tiles,
                                 const ReliefPatches& patches, bool foreign, double spacing,
                                 const LikenessOptions& options, const std::string& where);

// The measured heights, but for ground that no camera saw, which gets patches of seen ground as above.
// Between both, heights go over as the weights of the patches of wide heights do.
std::vector<double> filled_heights(const ReliefPatches& patches, double spacing,
                                   const LikenessOptions& options);

}  // namespace astrolith
