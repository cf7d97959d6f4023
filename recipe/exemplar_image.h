// The image that a layer names by its file, and the image's pixels.
#pragma once

#include <cstdint>
#include <filesystem>
#include <memory>
#include <string>
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

// What a layer with an image states of it. load_recipe() (tasks/job/load_recipe.h) decodes the file.
struct NamedImage {
  std::string image;         // path of a PNG file, relative to the folder of the recipe
  std::string image_sha256;  // SHA-256 of that file, 64 hexadecimal digits

  // The decoded image, which is no field of the recipe. Null: the layer cannot be evaluated.
  std::shared_ptr<const ExemplarImage> pixels;
};

// The sides of an exemplar, in pixels. Programs refuse images outside this range before they decode them.
inline constexpr int kLeastExemplarSide = 16, kMostExemplarSide = 8192;

}  // namespace astrolith
