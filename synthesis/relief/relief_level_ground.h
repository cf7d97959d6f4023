// What the levels of a relief below the model are made of, and the levels at a site:
// ground like that of the relief, on a plane that repeats, made smaller.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "recipe/noise_layers.h"
#include "synthesis/body/layer_site.h"
#include "synthesis/relief/relief_levels.h"
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

// What the levels are made of, whatever their site.
struct LevelGround {
  ExemplarLayer texture;             // of level 0, with its pixels
  double exponent = 1.0;             // H
  std::vector<std::uint16_t> codes;  // of the roughness at the places
  float step = 0.0f;                 // length units
};

// The ground of levels on a body with these heights at its places, like that of `patches`. The roughness
// is the root mean square of narrow heights around a place, with a standard deviation of 4 edges.
LevelGround level_ground(const ReliefPatches& patches, const ReliefPoints& points,
                         const std::vector<double>& heights, std::uint32_t hash);

// The levels 1 to `count` at a site, without their words. A level that has too many anchors there is left
// out, and `detail` gets the finest pixel and the share of the levels' variance that is left out.
ReliefLevels place_levels(const LevelGround& ground, int count, const std::string& place, std::uint32_t hash,
                          const LayerSite& site, ArrayStore& arrays, NoiseDetail& detail);

}  // namespace astrolith
