// Heights like the measured ones, in other places: patches of them are laid around other anchors. A body of
// the kind then has whole boulders and craters where the measured one has others.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "synthesis/relief/relief_patches.h"

namespace astrolith {

struct LikenessOptions {
  double reach = 0.3;  // how far donors are looked for at first, as a share of the body's diagonal
  bool fill = false;   // whether unseen ground (relief_patches.h) gets patches of seen ground
  std::uint32_t hash = 0;
};

// New heights at places of a body with their tiles, from those measured on it or, with `foreign`, on another
// one.
//
// Patches are laid around anchors (relief_laying.h). They hold the bands of the measured surface: its heights
// and the bends of its base, which are taken away where they stand. What is wider than all bands stays; on
// another body it is laid with the widest band. Bands of the result become as strong as those that were
// measured, by the geometric mean over the body of the root mean square around a place. Throws InputError,
// which begins with `where`, where fewer than ten anchors have been measured.
std::vector<double> like_heights(const std::vector<ReliefPlace>& places, const ReliefTiles& tiles,
                                 const ReliefPatches& patches, bool foreign, double spacing,
                                 const LikenessOptions& options, const std::string& where);

// The measured heights, but for ground that no camera saw, which gets patches of seen ground as above. Seams
// part both.
std::vector<double> filled_heights(const ReliefPatches& patches, double spacing,
                                   const LikenessOptions& options);

}  // namespace astrolith
