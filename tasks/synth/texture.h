// The part of synth that draws textures: a recipe's layers on a plane, the heights of the first Gabor or
// exemplar layer, or colours. Colours are those of the first layer with a color: of this layer alone if it is
// an exemplar, else of all Gabor layers that have one.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "numerics/progress.h"
#include "recipe/recipe.h"
#include "synthesis/noise/plane_texture.h"
#include "tasks/job/job.h"

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

struct TextureRequest {
  std::string size;     // "1024x1024"; empty = no texture
  std::string content;  // "height", "color" or "material"; empty = colours where layers have them
  bool tileable = false;
  int bits = 16;  // in a channel of a PNG
};

// The files that the request makes for an output: the output itself, or the maps of a material.
std::vector<std::filesystem::path> texture_files(const TextureRequest& request,
                                                 const std::filesystem::path& output);

void declare_texture_options(Job& job, TextureRequest& request);

// Writes the texture that was asked for, .png or .tif, and its summary. Throws InputError where the request
// makes no sense or the recipe, read from `file`, holds no such layer.
void write_texture(Job& job, const TextureRequest& request, const Recipe& recipe,
                   const std::filesystem::path& file, const std::filesystem::path& output);

}  // namespace astrolith
