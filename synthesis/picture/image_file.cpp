#include "synthesis/picture/image_file.h"

#include <spng.h>
#include <tiffio.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <cstdlib>
#include <iterator>
#include <memory>
#include <string>

#include "numerics/errors.h"
#include "numerics/files/output_file.h"
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
PngDecoder make_decoder(const std::vector<std::uint8_t>& bytes) {
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
std::vector<std::uint16_t> decode_rgba(spng_ctx* decoder, std::size_t pixels, const std::string& file) {
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

// The longest side of an image, in pixels. PNG allows 2^31 - 1; this limit also keeps rows within memory.
constexpr int kMaxSide = 1 << 20;

void check_size(std::size_t values, std::size_t channels, int width, int height,
                const std::filesystem::path& file) {
  const bool sides_fit = width > 0 && height > 0 && width <= kMaxSide && height <= kMaxSide;
  if (!sides_fit || values != channels * static_cast<std::size_t>(width) * static_cast<std::size_t>(height)) {
    throw InputError(file.string() + ": an image of " + std::to_string(width) + " x " +
                     std::to_string(height) + " does not fit its " + std::to_string(values) +
                     " values; give sides of 1 .. " + std::to_string(kMaxSide));
  }
}

struct PngLayout {
  int width, height, bit_depth;
  spng_color_type color_type;
  int compression = 6;  // of zlib
};

struct FreeEncoder {
  void operator()(spng_ctx* context) const { spng_ctx_free(context); }
};
struct FreeBytes {
  void operator()(void* bytes) const { std::free(bytes); }
};

// `name` begins the message of an error.
std::string encoded_png(const PngLayout& layout, std::span<const std::byte> data, const std::string& name) {
  const std::unique_ptr<spng_ctx, FreeEncoder> encoder(spng_ctx_new(SPNG_CTX_ENCODER));
  spng_ihdr header{static_cast<std::uint32_t>(layout.width),
                   static_cast<std::uint32_t>(layout.height),
                   static_cast<std::uint8_t>(layout.bit_depth),
                   static_cast<std::uint8_t>(layout.color_type),
                   0,
                   0,
                   SPNG_INTERLACE_NONE};
  const bool done =
      encoder != nullptr && spng_set_option(encoder.get(), SPNG_ENCODE_TO_BUFFER, 1) == 0 &&
      spng_set_option(encoder.get(), SPNG_IMG_COMPRESSION_LEVEL, layout.compression) == 0 &&
      spng_set_ihdr(encoder.get(), &header) == 0 &&
      spng_encode_image(encoder.get(), data.data(), data.size(), SPNG_FMT_PNG, SPNG_ENCODE_FINALIZE) == 0;
  std::size_t size = 0;
  int error = 0;
  const std::unique_ptr<void, FreeBytes> bytes(done ? spng_get_png_buffer(encoder.get(), &size, &error)
                                                    : nullptr);
  if (bytes == nullptr) throw WorkError(name + ": the image could not be encoded as PNG");
  return {static_cast<const char*>(bytes.get()), size};
}

void write_png(const PngLayout& layout, std::span<const std::byte> data,
               const std::filesystem::path& target) {
  OutputFile file(target);
  const std::string bytes = encoded_png(layout, data, target.string());
  file.write(bytes.data(), bytes.size());
  file.commit();
}

struct CloseTiff {
  void operator()(TIFF* tiff) const { TIFFClose(tiff); }
};

// The tags of GeoTIFF 1.1 and of GDAL that libtiff does not know by itself.
constexpr std::uint32_t kPixelScale = 33550, kTiePoint = 33922, kGeoKeys = 34735, kGeoText = 34737,
                        kMetadata = 42112, kNoData = 42113;

void declare_geo_tags(TIFF* tiff) {
  static char names[6][20] = {"ModelPixelScale", "ModelTiepoint", "GeoKeyDirectory",
                              "GeoAsciiParams",  "GDAL_NODATA",   "GDAL_METADATA"};
  const std::array<TIFFFieldInfo, 6> fields{{{kPixelScale, -1, -1, TIFF_DOUBLE, FIELD_CUSTOM, 1, 1, names[0]},
                                             {kTiePoint, -1, -1, TIFF_DOUBLE, FIELD_CUSTOM, 1, 1, names[1]},
                                             {kGeoKeys, -1, -1, TIFF_SHORT, FIELD_CUSTOM, 1, 1, names[2]},
                                             {kGeoText, -1, -1, TIFF_ASCII, FIELD_CUSTOM, 1, 0, names[3]},
                                             {kNoData, -1, -1, TIFF_ASCII, FIELD_CUSTOM, 1, 0, names[4]},
                                             {kMetadata, -1, -1, TIFF_ASCII, FIELD_CUSTOM, 1, 0, names[5]}}};
  TIFFMergeFieldInfo(tiff, fields.data(), static_cast<std::uint32_t>(fields.size()));
}

void set_geo_tags(TIFF* tiff, int width, int height, double pixel, const std::string& description) {
  declare_geo_tags(tiff);
  const std::array<double, 3> scale{pixel, pixel, 0.0};
  const std::array<double, 6> tie{0, 0, 0, -0.5 * width * pixel, 0.5 * height * pixel, 0};
  static constexpr char kCitation[] = "local plane in metres|";
  // Model projected and user-defined, pixels are areas, lengths in metres.
  const std::array<std::uint16_t, 24> keys{1,    1,     0,  5, 1024, 0, 1, 1,     1025, 0, 1, 1,
                                           1026, 34737, 22, 0, 3072, 0, 1, 32767, 3076, 0, 1, 9001};
  static_assert(sizeof kCitation - 1 == 22);
  TIFFSetField(tiff, TIFFTAG_IMAGEDESCRIPTION, description.c_str());
  TIFFSetField(tiff, kPixelScale, 3, scale.data());
  TIFFSetField(tiff, kTiePoint, 6, tie.data());
  TIFFSetField(tiff, kGeoKeys, static_cast<int>(keys.size()), keys.data());
  TIFFSetField(tiff, kGeoText, kCitation);
  TIFFSetField(tiff, kNoData, "nan");
}

// What GDAL reads the names of bands from.
std::string band_metadata(const std::vector<std::string>& bands) {
  std::string text = "<GDALMetadata>\n";
  for (std::size_t k = 0; k < bands.size(); ++k) {
    text += "  <Item name=\"DESCRIPTION\" sample=\"" + std::to_string(k) + "\" role=\"description\">" +
            bands[k] + "</Item>\n";
  }
  return text + "</GDALMetadata>\n";
}

bool write_tiff_rows(TIFF* tiff, std::span<const float> values, int width, int height, int channels) {
  TIFFSetField(tiff, TIFFTAG_IMAGEWIDTH, static_cast<std::uint32_t>(width));
  TIFFSetField(tiff, TIFFTAG_IMAGELENGTH, static_cast<std::uint32_t>(height));
  TIFFSetField(tiff, TIFFTAG_SAMPLESPERPIXEL, channels);
  TIFFSetField(tiff, TIFFTAG_BITSPERSAMPLE, 32);
  TIFFSetField(tiff, TIFFTAG_SAMPLEFORMAT, SAMPLEFORMAT_IEEEFP);
  TIFFSetField(tiff, TIFFTAG_PLANARCONFIG, PLANARCONFIG_CONTIG);
  TIFFSetField(tiff, TIFFTAG_ROWSPERSTRIP, TIFFDefaultStripSize(tiff, 0));
  const auto row_size = static_cast<std::size_t>(width) * static_cast<std::size_t>(channels);
  for (std::size_t y = 0; y < static_cast<std::size_t>(height); ++y) {
    std::vector<float> row(values.begin() + static_cast<std::ptrdiff_t>(y * row_size),
                           values.begin() + static_cast<std::ptrdiff_t>((y + 1) * row_size));
    if (TIFFWriteScanline(tiff, row.data(), static_cast<std::uint32_t>(y)) != 1) return false;
  }
  return TIFFFlush(tiff) == 1;
}

// The picture's values with the first `channels` of each pixel.
template <typename Value, typename Convert>
std::vector<Value> first_channels(const RgbaImage16& image, std::size_t channels, const Convert& convert) {
  std::vector<Value> values;
  values.reserve(image.pixels.size() / 4 * channels);
  for (std::size_t i = 0; i < image.pixels.size(); i += 4) {
    for (std::size_t k = 0; k < channels; ++k) values.push_back(convert(image.pixels[i + k]));
  }
  return values;
}

std::uint8_t to_byte(std::uint16_t value) { return static_cast<std::uint8_t>((value + 128u) / 257u); }

}  // namespace

GreyPng decode_grey_png(const std::vector<std::uint8_t>& bytes, const std::string& file, int least_side,
                        int most_side) {
  if (!begins_as_png(bytes))
    throw InputError(file + ": is no PNG; convert it, or let fit_gabor --model exemplar write one");
  const PngDecoder decoder = make_decoder(bytes);
  spng_ihdr header{};
  if (const int status = spng_get_ihdr(decoder.get(), &header); status != 0) refuse(file, status);
  const auto [least, most] = std::minmax(header.width, header.height);
  if (least < static_cast<std::uint32_t>(least_side) || most > static_cast<std::uint32_t>(most_side)) {
    throw InputError(file + ": is " + std::to_string(header.width) + " x " + std::to_string(header.height) +
                     " pixels; cut out or scale it to sides of " + std::to_string(least_side) + " to " +
                     std::to_string(most_side));
  }
  const std::size_t pixels = std::size_t{header.width} * header.height;
  const std::vector<std::uint16_t> rgba = decode_rgba(decoder.get(), pixels, file);
  GreyPng png{static_cast<int>(header.width), static_cast<int>(header.height), {}};
  png.values.reserve(pixels);
  if (!is_grey(header)) png.rgb.reserve(3 * pixels);
  for (std::size_t i = 0; i < rgba.size(); i += 4) {
    if (is_grey(header)) {
      png.values.push_back(rgba[i]);
    } else {
      png.values.push_back(rgb_luma(rgba[i], rgba[i + 1], rgba[i + 2]));
      png.rgb.insert(png.rgb.end(), {rgba[i], rgba[i + 1], rgba[i + 2]});
    }
  }
  return png;
}

RgbImage opaque_bytes(const RgbaImage16& image) {
  return {image.width, image.height, first_channels<std::uint8_t>(image, 3, to_byte)};
}

std::vector<std::uint8_t> rgba_bytes(const RgbaImage16& image) {
  return first_channels<std::uint8_t>(image, 4, to_byte);
}

void write_png(const RgbaImage16& image, int bits, bool with_alpha, const std::filesystem::path& file) {
  check_size(image.pixels.size(), 4, image.width, image.height, file);
  const std::size_t channels = with_alpha ? 4 : 3;
  const spng_color_type type = with_alpha ? SPNG_COLOR_TYPE_TRUECOLOR_ALPHA : SPNG_COLOR_TYPE_TRUECOLOR;
  if (bits == 16) {
    const auto values = first_channels<std::uint16_t>(image, channels, [](std::uint16_t v) { return v; });
    return write_png({image.width, image.height, 16, type}, std::as_bytes(std::span(values)), file);
  }
  const auto bytes = first_channels<std::uint8_t>(image, channels, to_byte);
  constexpr int kFast = 4;  // a tenth of a preview's time less than 6, for 7 % more bytes
  write_png({image.width, image.height, 8, type, kFast}, std::as_bytes(std::span(bytes)), file);
}

namespace {

template <class Value>
std::string png_bytes(std::span<const Value> values, int width, int height, int channels) {
  constexpr int kFast = 3;
  check_size(values.size(), static_cast<std::size_t>(channels), width, height, "PNG");
  const spng_color_type type = channels == 1 ? SPNG_COLOR_TYPE_GRAYSCALE : SPNG_COLOR_TYPE_TRUECOLOR;
  return encoded_png({width, height, 8 * static_cast<int>(sizeof(Value)), type, kFast}, std::as_bytes(values),
                     "PNG");
}

}  // namespace

std::string encode_png(std::span<const std::uint8_t> values, int width, int height, int channels) {
  return png_bytes(values, width, height, channels);
}

std::string encode_png(std::span<const std::uint16_t> values, int width, int height, int channels) {
  return png_bytes(values, width, height, channels);
}

void write_png8_rgb(const RgbImage& image, const std::filesystem::path& file) {
  check_size(image.pixels.size(), 3, image.width, image.height, file);
  write_png({image.width, image.height, 8, SPNG_COLOR_TYPE_TRUECOLOR}, std::as_bytes(std::span(image.pixels)),
            file);
}

void write_png8_grey(std::span<const std::uint8_t> grey, int width, int height,
                     const std::filesystem::path& file) {
  check_size(grey.size(), 1, width, height, file);
  write_png({width, height, 8, SPNG_COLOR_TYPE_GRAYSCALE}, std::as_bytes(grey), file);
}

void write_png16_grey(std::span<const std::uint16_t> grey, int width, int height,
                      const std::filesystem::path& file) {
  check_size(grey.size(), 1, width, height, file);
  write_png({width, height, 16, SPNG_COLOR_TYPE_GRAYSCALE}, std::as_bytes(grey), file);
}

void write_png16_rgb(std::span<const std::uint16_t> rgb, int width, int height,
                     const std::filesystem::path& file) {
  check_size(rgb.size(), 3, width, height, file);
  write_png({width, height, 16, SPNG_COLOR_TYPE_TRUECOLOR}, std::as_bytes(rgb), file);
}

namespace {

// Opens the file, lets set_tags() add tags and writes the rows.
template <typename SetTags>
void write_floats(std::span<const float> values, int width, int height, const std::filesystem::path& file,
                  int channels, const SetTags& set_tags) {
  check_size(values.size(), static_cast<std::size_t>(channels), width, height, file);
  OutputFile target(file);
  TIFFSetErrorHandler(nullptr);  // libraries never print; failures are returned as statuses
  TIFFSetWarningHandler(nullptr);
  const int descriptor = target.duplicate_descriptor();
  std::unique_ptr<TIFF, CloseTiff> tiff(TIFFFdOpen(descriptor, file.c_str(), "w"));
  if (tiff == nullptr) ::close(descriptor);
  if (tiff != nullptr) set_tags(tiff.get());
  if (tiff == nullptr || !write_tiff_rows(tiff.get(), values, width, height, channels)) {
    throw WorkError(file.string() + ": writing failed; is the disk full?");
  }
  tiff.reset();
  target.commit();
}

}  // namespace

void write_tiff_float(std::span<const float> values, int width, int height, const std::filesystem::path& file,
                      int channels) {
  write_floats(values, width, height, file, channels, [&](TIFF* tiff) {
    TIFFSetField(tiff, TIFFTAG_PHOTOMETRIC, channels == 3 ? PHOTOMETRIC_RGB : PHOTOMETRIC_MINISBLACK);
  });
}

void write_geotiff(std::span<const float> values, int width, int height, double pixel,
                   const std::string& description, const std::filesystem::path& file,
                   const std::vector<std::string>& bands) {
  write_floats(
      values, width, height, file, bands.empty() ? 1 : static_cast<int>(bands.size()), [&](TIFF* tiff) {
        set_geo_tags(tiff, width, height, pixel, description);
        if (bands.size() > 1) {
          const std::vector<std::uint16_t> unspecified(bands.size() - 1, EXTRASAMPLE_UNSPECIFIED);
          TIFFSetField(tiff, TIFFTAG_SAMPLESPERPIXEL, static_cast<int>(bands.size()));
          TIFFSetField(tiff, TIFFTAG_EXTRASAMPLES, static_cast<int>(unspecified.size()), unspecified.data());
        }
        if (!bands.empty()) TIFFSetField(tiff, kMetadata, band_metadata(bands).c_str());
        TIFFSetField(tiff, TIFFTAG_PHOTOMETRIC, PHOTOMETRIC_MINISBLACK);
      });
}

}  // namespace astrolith
