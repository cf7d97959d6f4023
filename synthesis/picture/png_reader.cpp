#include "synthesis/picture/png_reader.h"

#include <spng.h>

#include <algorithm>
#include <cstddef>
#include <iterator>
#include <memory>

#include "numerics/errors.h"
#include "numerics/srgb.h"

namespace astrolith {
namespace {

struct FreeDecoder {
  void operator()(spng_ctx* context) const { spng_ctx_free(context); }
};
using PngDecoder = std::unique_ptr<spng_ctx, FreeDecoder>;

bool begins_as_png(const std::vector<std::uint8_t>& bytes) {
  constexpr std::uint8_t kSignature[] = {0x89, 'P', 'N', 'G', '\r', '\n', 0x1a, '\n'};
  return bytes.size() >= std::size(kSignature) &&
         std::equal(std::begin(kSignature), std::end(kSignature), bytes.begin());
}

// A decoder of bytes that outlive it. What a file says beside its pixels may be damaged, and takes at most
// kMostNotes bytes, unpacked.
PngDecoder decoder_of(const std::vector<std::uint8_t>& bytes) {
  constexpr std::size_t kMostNotes = 1 << 20;
  PngDecoder decoder(spng_ctx_new(0));
  const bool ready = decoder != nullptr &&
                     spng_set_crc_action(decoder.get(), SPNG_CRC_ERROR, SPNG_CRC_DISCARD) == 0 &&
                     spng_set_chunk_limits(decoder.get(), kMostNotes, kMostNotes) == 0 &&
                     spng_set_png_buffer(decoder.get(), bytes.data(), bytes.size()) == 0;
  if (!ready) throw WorkError("PNG: no memory for a decoder");
  return decoder;
}

[[noreturn]] void refuse(const std::string& file, int status) {
  throw InputError(file + ": is damaged, or no PNG that libspng reads (" + spng_strerror(status) +
                   "); write it again");
}

// All pixels as red, green, blue and alpha. libspng has no 16-bit format without alpha that takes every kind
// of file.
std::vector<std::uint16_t> rgba_of(spng_ctx* decoder, std::size_t pixels, const std::string& file) {
  std::vector<std::uint16_t> rgba(4 * pixels);
  int status = spng_decode_image(decoder, rgba.data(), rgba.size() * sizeof rgba[0], SPNG_FMT_RGBA16, 0);
  if (status == 0) status = spng_decode_chunks(decoder);
  if (status != 0) refuse(file, status);
  return rgba;
}

bool is_grey(const spng_ihdr& header) {
  return header.color_type == SPNG_COLOR_TYPE_GRAYSCALE ||
         header.color_type == SPNG_COLOR_TYPE_GRAYSCALE_ALPHA;
}

}  // namespace

GreyPng decode_grey_png(const std::vector<std::uint8_t>& bytes, const std::string& file, int least_side,
                        int most_side) {
  if (!begins_as_png(bytes))
    throw InputError(file + ": is no PNG; convert it, or let fit_gabor --model exemplar write one");
  const PngDecoder decoder = decoder_of(bytes);
  spng_ihdr header{};
  if (const int status = spng_get_ihdr(decoder.get(), &header); status != 0) refuse(file, status);
  const auto [least, most] = std::minmax(header.width, header.height);
  if (least < static_cast<std::uint32_t>(least_side) || most > static_cast<std::uint32_t>(most_side)) {
    throw InputError(file + ": is " + std::to_string(header.width) + " x " + std::to_string(header.height) +
                     " pixels; cut out or scale it to sides of " + std::to_string(least_side) + " to " +
                     std::to_string(most_side));
  }
  const std::size_t pixels = std::size_t{header.width} * header.height;
  const std::vector<std::uint16_t> rgba = rgba_of(decoder.get(), pixels, file);
  GreyPng png{static_cast<int>(header.width), static_cast<int>(header.height), {}};
  png.values.reserve(pixels);
  if (!is_grey(header)) png.rgb.reserve(3 * pixels);
  for (std::size_t i = 0; i < rgba.size(); i += 4) {
    if (is_grey(header)) {
      png.values.push_back(rgba[i]);
    } else {
      png.values.push_back(luma_of(rgba[i], rgba[i + 1], rgba[i + 2]));
      png.rgb.insert(png.rgb.end(), {rgba[i], rgba[i + 1], rgba[i + 2]});
    }
  }
  return png;
}

}  // namespace astrolith
