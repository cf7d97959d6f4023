// Ground like that of a relief, on a plane that repeats. Made smaller, it continues the relief below the
// edges of the model that was measured.
#pragma once

#include <cstdint>
#include <vector>

#include "synthesis/relief/relief_patches.h"

namespace astrolith {

struct ReliefTexture {
  int side = 0;                 // pixels
  double pixel = 0.0;           // length units
  std::vector<double> heights;  // (side x side) over the root mean square of narrow heights where they stood
  // H of the power law S(l) = S(1) l^H, with S(l) the root mean square of second differences of heights at
  // the lag l, between 1 and 4 edges; .3 to 1.5.
  double exponent = 1.0;
};

// A plane of 128 by 128 edges. Patches of donors on rough ground, where the base bends little, are laid about
// points of a jittered lattice and blended as PatchSums does; each is divided by its own roughness. Waves
// longer than some 9 edges are taken away (weights of 1.5 edges' standard deviation): the model has them.
// Expects measured heights that are not all the same around some anchor; else all heights are 0.
ReliefTexture relief_texture(const ReliefPatches& patches, std::uint32_t hash);

}  // namespace astrolith
