#include <fmt/format.h>
#include <tiffio.h>

#include <algorithm>
#include <array>
#include <cstring>
#include <fstream>
#include <new>
#include <span>
#include <vector>

#include "estimation/gabor/image/image_codec_internal.h"
#include "numerics/errors.h"
#include "numerics/files/input_file.h"

namespace astrolith {
namespace {

using Bytes = std::array<unsigned char, 26>;

std::uint32_t big_endian(const unsigned char* p, int bytes) {
  std::uint32_t value = 0;
  for (int i = 0; i < bytes; ++i) value = value << 8 | p[i];
  return value;
}

// Bytes 16 to 25 of a PNG are width, height, bit depth and colour type of its first chunk, IHDR. The chunks
// before the pixels, IDAT, say whether it is animated (acTL) or has transparent colours (tRNS).
ImageHeader png_header(std::ifstream& in, const Bytes& start) {
  ImageHeader header{"PNG", big_endian(start.data() + 16, 4), big_endian(start.data() + 20, 4)};
  header.has_alpha = (start[25] & 4) != 0;
  in.seekg(8);
  for (int chunk = 0; chunk < 10000; ++chunk) {
    unsigned char head[8];
    if (!in.read(reinterpret_cast<char*>(head), 8) || std::memcmp(head + 4, "IDAT", 4) == 0) break;
    if (std::memcmp(head + 4, "acTL", 4) == 0) header.more_pages = true;
    if (std::memcmp(head + 4, "tRNS", 4) == 0) header.has_alpha = true;
    in.seekg(std::streamoff{big_endian(head, 4)} + 4, std::ios::cur);  // the data and their checksum
  }
  return header;
}

// Whether the end of a JPEG, FF D9, still follows. Decoders fill the missing part of a cut file with grey and
// do not report it. FF D9 cannot occur inside a scan.
bool jpeg_ends(std::ifstream& in) {
  std::vector<char> block(std::size_t{1} << 16);
  bool after_ff = false;
  while (in.read(block.data(), static_cast<std::streamsize>(block.size())), in.gcount() > 0) {
    for (const char c : std::span(block).first(static_cast<std::size_t>(in.gcount()))) {
      if (after_ff && c == '\xd9') return true;
      after_ff = c == '\xff';
    }
  }
  return false;
}

// A JPEG is a chain of segments that begin with FF, a marker and a length. The segment of the frame header
// holds the size; its marker is C0 to CF, but not C4, C8 or CC.
ImageHeader jpeg_header(std::ifstream& in, const std::string& name) {
  in.seekg(2);
  for (int segment = 0; segment < 10000; ++segment) {
    unsigned char head[9] = {};
    if (!in.read(reinterpret_cast<char*>(head), 4) || head[0] != 0xff) break;
    if (head[1] == 0xff) {  // fill bytes may stand before a marker
      in.seekg(-3, std::ios::cur);
      continue;
    }
    const bool frame =
        head[1] >= 0xc0 && head[1] <= 0xcf && head[1] != 0xc4 && head[1] != 0xc8 && head[1] != 0xcc;
    if (frame && in.read(reinterpret_cast<char*>(head) + 4, 5)) {
      if (!jpeg_ends(in)) throw InputError(name + ": ends too early; the file is damaged, fetch it again");
      return {"JPEG", big_endian(head + 7, 2), big_endian(head + 5, 2)};
    }
    const std::uint32_t length = big_endian(head + 2, 2);
    if (frame || length < 2) break;
    in.seekg(length - 2, std::ios::cur);
  }
  throw InputError(name + ": JPEG without a frame header; the file is damaged, save it again");
}

// Opens a TIFF such that no field of its directory takes much more memory than the file has bytes: a file of
// a hundred bytes can declare a field of a gigabyte.
TIFF* open_tiff(const std::string& name) {
  constexpr std::uintmax_t kFixed = std::uintmax_t{1} << 20, kEachByte = 8, kMost = std::uintmax_t{1} << 30;
  TIFFOpenOptions* options = TIFFOpenOptionsAlloc();
  if (options == nullptr) throw std::bad_alloc();
  const std::uintmax_t most = std::min(kMost, kFixed + kEachByte * std::filesystem::file_size(name));
  TIFFOpenOptionsSetMaxSingleMemAlloc(options, static_cast<tmsize_t>(most));
  TIFF* tiff = TIFFOpenExt(name.c_str(), "r", options);
  TIFFOpenOptionsFree(options);
  return tiff;
}

ImageHeader tiff_header(const std::string& name) {
  // Without handlers libtiff does not print.
  TIFFSetErrorHandler(nullptr);
  TIFFSetWarningHandler(nullptr);
  TIFF* tiff = open_tiff(name);
  if (tiff == nullptr) throw InputError(name + ": TIFF cannot be opened; the file is damaged, save it again");
  ImageHeader header{"TIFF"};
  TIFFGetField(tiff, TIFFTAG_IMAGEWIDTH, &header.width);
  TIFFGetField(tiff, TIFFTAG_IMAGELENGTH, &header.height);
  std::uint16_t bits = 0, format = SAMPLEFORMAT_UINT, extra = 0;
  std::uint16_t* kinds = nullptr;
  TIFFGetFieldDefaulted(tiff, TIFFTAG_BITSPERSAMPLE, &bits);
  TIFFGetFieldDefaulted(tiff, TIFFTAG_SAMPLEFORMAT, &format);
  TIFFGetFieldDefaulted(tiff, TIFFTAG_EXTRASAMPLES, &extra, &kinds);
  header.has_alpha = extra > 0;
  header.half_floats = bits == 16 && format == SAMPLEFORMAT_IEEEFP;
  header.more_pages = TIFFLastDirectory(tiff) == 0;
  TIFFClose(tiff);
  return header;
}

}  // namespace

ImageHeader read_image_header(const std::filesystem::path& file) {
  require_plain_file(file);
  const std::string name = file.string();
  std::ifstream in(file, std::ios::binary);
  if (!in) throw InputError(name + ": cannot be read; check its rights");
  Bytes start{};
  in.read(reinterpret_cast<char*>(start.data()), start.size());
  const bool whole = in.gcount() == static_cast<std::streamsize>(start.size());
  in.clear();
  if (whole && std::memcmp(start.data(), "\x89PNG\r\n\x1a\n", 8) == 0) return png_header(in, start);
  if (whole && std::memcmp(start.data(), "\xff\xd8\xff", 3) == 0) return jpeg_header(in, name);
  const bool tiff = std::memcmp(start.data(), "II*\0", 4) == 0 ||
                    std::memcmp(start.data(), "MM\0*", 4) == 0 ||
                    std::memcmp(start.data(), "II+\0", 4) == 0 || std::memcmp(start.data(), "MM\0+", 4) == 0;
  if (whole && tiff) return tiff_header(name);
  throw InputError(name + ": its first bytes are not those of a PNG, JPEG or TIFF image; convert it to one");
}

}  // namespace astrolith
