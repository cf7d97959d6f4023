// Rendered pictures with their captions in a dark strip above them.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "synthesis/picture/image_file.h"

namespace astrolith {

struct CaptionedPicture {
  RgbImage image;
  std::string caption;
};

// The ends of sequential_color, as text: "0" and "0.25 %".
struct ColorScaleLabels {
  std::string low, high;
};

// Writes the pictures side by side as one PNG, pixel by pixel; all have the same height. Throws InputError
// where the file cannot be written.
void write_captioned_pictures(const std::vector<CaptionedPicture>& pictures,
                              const std::filesystem::path& file);

// Writes one picture as PNG, with a bar of sequential_color at the right end of the strip.
void write_picture_with_scale(const CaptionedPicture& picture, const ColorScaleLabels& scale,
                              const std::filesystem::path& file);

}  // namespace astrolith
