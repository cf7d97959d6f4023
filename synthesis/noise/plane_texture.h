// A layer drawn on a plane. A kind whose traits say that it shows there has two functions in its room:
//   PlaneTexture heights_on_plane(const Kind& layer, const PlaneDrawing& drawing);
//   PlaneTexture colors_on_plane(const Kind& layer, const PlaneDrawing& drawing);    of a layer with a colour
#pragma once

#include <cstddef>
#include <string>
#include <vector>

#include "numerics/progress.h"
#include "recipe/recipe.h"

namespace astrolith {

struct PlaneTexture {
  int channels = 1;           // 1: heights; 3: red, green and blue, full scale 1, not clamped
  std::vector<float> values;  // (height x width x channels), the top row first
  std::size_t layers = 1;     // number of layers drawn
  double height_rms = 0.0;    // standard deviation of the heights, length units
  bool has_height = true;     // false: the layer states no height, and the unit is its standard deviation
};

struct PlaneDrawing {
  const Recipe& recipe;
  std::size_t index;  // of the layer in the recipe
  std::string place;  // "rock.json: layers[2]", for messages
  int width, height;  // pixels
  bool tileable;      // whether the texture repeats after its width and height without a seam
  const Progress& progress;
};

// The layer, in units of its own standard deviation where it states no height; `texture` learns which.
template <class Kind>
Kind with_height(Kind layer, PlaneTexture& texture) {
  texture.has_height = layer.has_height();
  if (!texture.has_height) layer.height_rms = 1.0;
  return layer;
}

}  // namespace astrolith
