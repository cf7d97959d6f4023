// A recipe's texture layers drawn on a plane: the heights of the first Gabor or exemplar layer, or colours.
// Colours are those of the first layer with a color: of this layer alone if it is an exemplar, else of all
// Gabor layers that have one.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "numerics/progress.h"
#include "recipe/recipe.h"
#include "synthesis/noise/plane_texture.h"

namespace astrolith {

inline constexpr int kMaxTextureSide = 16384;

struct PlaneTextureRequest {
  int width = 0, height = 0;  // pixels, 1 .. kMaxTextureSide
  std::string content;        // "height" or "color"; empty: colours where layers have them
  bool tileable = false;      // the texture repeats in both directions without a seam
};

// Draws the texture. `file` is the recipe's file, for messages. Throws InputError for a side out of range,
// for a recipe without such a layer, and what synthesize_texture() throws. Throws WorkError when progress
// asks to stop.
PlaneTexture draw_texture(const Recipe& recipe, const std::string& file, const PlaneTextureRequest& request,
                          const Progress& progress);

// The maps of a material, which belong to the same pixels of the recipe's first Gabor or exemplar layer.
struct PlaneMaterial {
  PlaneTexture height;
  std::optional<PlaneTexture> color;  // absent where the layer has no color
  std::vector<float> normal;          // normal_map() of the heights
  std::vector<float> occlusion;       // occlusion_map() of the heights
  double pixel_size = 1.0;            // length units
};

// Draws a material; the request's content is not read. Throws as draw_texture() does, and InputError for a
// layer without a height.
PlaneMaterial draw_material(const Recipe& recipe, const std::string& file, const PlaneTextureRequest& request,
                            const Progress& progress);

}  // namespace astrolith
