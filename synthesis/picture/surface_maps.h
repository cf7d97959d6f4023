// Normals and ambient occlusion of a height map, as materials of renderers take them.
#pragma once

#include <span>
#include <vector>

#include "numerics/progress.h"

namespace astrolith {

// A height map at pixel centres, row-major, the top row first.
struct HeightGrid {
  std::span<const float> heights;  // (height x width), length units
  int width = 0, height = 0;       // pixels
  double pixel_size = 1.0;         // length units
  bool repeats = false;  // whether the map goes on as a copy of itself; otherwise it ends at its border
};

// Unit normals (height x width x 3): x to the right, y up the picture, z out of it. A material calls these
// the OpenGL convention. Slopes are central differences, one-sided at the border of a map that ends.
std::vector<float> normal_map(const HeightGrid& grid, const Progress& progress = {});

// The ambient occlusion (height x width), in [0, 1], 1 for open ground: the share of the light of an even sky
// that reaches a point, weighted by the cosine from the vertical,
//   mean over 16 azimuths of cos^2(elevation of the horizon),
// where the horizon is that of the heights up to kOcclusionReach pixels away.
inline constexpr int kOcclusionAzimuths = 16, kOcclusionReach = 64;
std::vector<float> occlusion_map(const HeightGrid& grid, const Progress& progress = {});

}  // namespace astrolith
