// Reads PNG files as grey images, with their colours. Writes pictures and height maps into files, which are
// whole or absent (numerics/files/output_file.h). All arrays are row-major, the top row first. Sides are 1 ..
// 2^20 pixels. Every function throws InputError when the target cannot be written or when width * height does
// not match the array, and WorkError when writing fails half-way.
#pragma once

#include <cstdint>
#include <filesystem>
#include <span>
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

struct RgbImage {
  int width = 0;
  int height = 0;
  std::vector<std::uint8_t> pixels;  // (height x width x 3) sRGB
};

// A picture with coverage, of 16 bits.
struct RgbaImage16 {
  int width = 0;
  int height = 0;
  std::vector<std::uint16_t> pixels;  // (height x width x 4) sRGB and alpha, not multiplied by alpha
};

// The picture rounded to 8 bits, without its alpha.
RgbImage opaque_bytes(const RgbaImage16& image);

// The picture rounded to 8 bits, (height x width x 4).
std::vector<std::uint8_t> rgba_bytes(const RgbaImage16& image);

// Writes a PNG of 8 or 16 bits, with or without alpha.
void write_png(const RgbaImage16& image, int bits, bool with_alpha, const std::filesystem::path& file);

// The bytes of a PNG of 8 or of 16 bits (1 channel: grey, 3: RGB), for a file that holds images.
// values: (height x width x channels)
std::string encode_png(std::span<const std::uint8_t> values, int width, int height, int channels);
std::string encode_png(std::span<const std::uint16_t> values, int width, int height, int channels = 1);

void write_png8_rgb(const RgbImage& image, const std::filesystem::path& file);

// grey: (height x width)
void write_png8_grey(std::span<const std::uint8_t> grey, int width, int height,
                     const std::filesystem::path& file);
void write_png16_grey(std::span<const std::uint16_t> grey, int width, int height,
                      const std::filesystem::path& file);

// rgb: (height x width x 3)
void write_png16_rgb(std::span<const std::uint16_t> rgb, int width, int height,
                     const std::filesystem::path& file);

// Writes 32-bit floats, uncompressed: heights whose unit matters (1 channel) and colours (3 channels, RGB).
// values: (height x width x channels)
void write_tiff_float(std::span<const float> values, int width, int height, const std::filesystem::path& file,
                      int channels = 1);

// Writes a height map of a local plane that GDAL and GIS programs read: a GeoTIFF of 32-bit floats, row-major
// with the top row first, uncompressed. The map is a plane in metres without a datum: `pixel` metres a pixel,
// zero at the middle of the map, x to the right and y up. NaN is stated as the value of no data.
// `description` becomes the image's description. Throws what write_tiff_float() throws. values: (height x
// width x bands), of which there is one where `bands` has no names; names have letters, digits and "_" only.
void write_geotiff(std::span<const float> values, int width, int height, double pixel,
                   const std::string& description, const std::filesystem::path& file,
                   const std::vector<std::string>& bands = {});

}  // namespace astrolith
