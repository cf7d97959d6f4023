// An exemplar layer on a plane: a texture like its image, of any size.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "numerics/progress.h"
#include "recipe/recipe.h"
#include "synthesis/noise/plane_texture.h"

namespace astrolith {

struct PlaneExemplarOptions {
  std::uint64_t seed = 1;
  int layer_index = 0;    // layers of one seed and different numbers are independent
  bool tileable = false;  // the texture repeats after its width and height without a seam
};

// Heights at pixel centres, row-major (height x width), x to the right, y down; length units, mean 0. A
// smaller texture is the top left part of a larger one, unless it is tileable. Throws as
// make_exemplar_texture() does, and InputError for a tileable side below half of an anchor cell. When
// `progress` asks to stop, the rows not yet made are 0. Expects sides of at least 1.
std::vector<float> synthesize_exemplar(const ExemplarLayer& layer, const std::string& place, int width,
                                       int height, const PlaneExemplarOptions& options,
                                       const Progress& progress = {});

// The colours of a layer at the same pixels, with the weights and offsets of the heights: RGB (height x width
// x 3), full scale = 1, not clamped to [0, 1]. Throws as synthesize_exemplar() does.
std::vector<float> synthesize_exemplar_colors(const ExemplarLayer& layer, const std::string& place, int width,
                                              int height, const PlaneExemplarOptions& options,
                                              const Progress& progress = {});

PlaneTexture heights_on_plane(const ExemplarLayer& layer, const PlaneDrawing& drawing);
PlaneTexture colors_on_plane(const ExemplarLayer& layer, const PlaneDrawing& drawing);

}  // namespace astrolith
