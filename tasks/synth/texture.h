// The part of synth that draws textures: heights or colours of a recipe's Gabor layers on a plane.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "recipe/recipe.h"
#include "tasks/job/job.h"

namespace astrolith {

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
