// The pixels of an exemplar's image. A recipe names the image's file; tasks/synthesis/load_recipe.h decodes
// it.
#pragma once

#include <cstdint>
#include <filesystem>
#include <vector>

namespace astrolith {

// An image of width x height pixels, row-major, the top row first. 0 is black, 65535 is full scale.
struct ExemplarImage {
  int width = 0;
  int height = 0;
  std::vector<std::uint16_t> values;    // grey values, or the luma of the colours
  std::filesystem::path file;           // absolute path of the file that was decoded
  std::vector<std::uint16_t> rgb = {};  // (height x width x 3); empty for a grey image
};

// The sides of an exemplar, in pixels. Programs refuse images outside this range before they decode them.
inline constexpr int kLeastExemplarSide = 16, kMostExemplarSide = 8192;

}  // namespace astrolith
