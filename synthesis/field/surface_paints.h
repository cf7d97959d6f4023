// What a recipe does to the colour of its surface, as blocks of a field evaluate it (recipe/albedo.h).
#pragma once

#include <cstdint>
#include <vector>

#include "numerics/vec3.h"
#include "synthesis/exemplar/exemplar_colors.h"

namespace astrolith {

// The albedo of a layer of noise.
struct NoiseTone {
  std::uint32_t layer = 0;  // number of the layer in the field's tables
  bool covers = false;      // whether `color` covers the ground
  Vec3f color;              // encoded as sRGB, full scale = 1
  float per_height = 0.0f;  // what the tone gains, per length unit of the layer's height
};

// The albedo of a layer of craters.
struct CraterTone {
  std::uint32_t layer = 0;       // number of the layer in the field's tables
  Vec3f fresh;                   // the tone of the youngest
  std::vector<float> freshness;  // of each crater in its list, [0, 1]
};

struct BoulderTone {
  bool covers = false;  // whether the boulder has an albedo of its own
  Vec3f color;          // encoded as sRGB, full scale = 1
  Vec3f tone;
};

// Layers in the recipe's order.
struct SurfacePaints {
  std::vector<LayerPaint> images;
  std::vector<NoiseTone> noises;
  std::vector<CraterTone> craters;
  std::vector<BoulderTone> boulders;  // by their numbers in the field; empty where none has an albedo
};

// A point of the surface. Its light in each channel is the linear light of `color` times exp(tone).
struct PaintedPoint {
  Vec3f color;  // encoded as sRGB, full scale = 1
  Vec3f tone;
  Vec3f up;                // unit normal of the bare body
  float elevation = 0.0f;  // of the ground above the bare body, length units
  bool on_boulder = false;
};

}  // namespace astrolith
