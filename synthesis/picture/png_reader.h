// Reads PNG files as grey images, with their colours.
#pragma once

#include <cstdint>
#include <filesystem>
#include <string>
#include <vector>

namespace astrolith {

// A grey image, row-major, the top row first. 0 is black, 65535 is white.
struct GreyPng {
  int width = 0;
  int height = 0;
  std::vector<std::uint16_t> values;
  std::vector<std::uint16_t> rgb = {};  // (height x width x 3); empty where the file is grey
};

// Decodes a PNG file that was read into memory. Channels have 1 to 16 bits; palettes are expanded, `values`
// is the luma of colours, and alpha is ignored. Takes 8 bytes a pixel beside the result. Throws InputError,
// which names `file`: for bytes that are no PNG, for a damaged file, and for sides outside least_side to
// most_side, before anything is decoded.
GreyPng decode_grey_png(const std::vector<std::uint8_t>& bytes, const std::string& file, int least_side,
                        int most_side);

}  // namespace astrolith
