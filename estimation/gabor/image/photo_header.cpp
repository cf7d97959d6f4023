#include <array>
#include <cstring>
#include <fstream>
#include <span>
#include <vector>

#include "estimation/gabor/image/photo_codec_internal.h"
#include "numerics/errors.h"
#include "numerics/files/input_file.h"

namespace astrolith {
namespace {

using Bytes = std::array<unsigned char, 30>;

std::uint32_t big_endian(const unsigned char* p, int bytes) {
  std::uint32_t value = 0;
  for (int i = 0; i < bytes; ++i) value = value << 8 | p[i];
  return value;
}

// Bytes 16 to 25 of a PNG are width, height, bit depth and colour type of its first chunk, IHDR. The chunks
// before the pixels, IDAT, say whether it is animated (acTL) or has transparent colours (tRNS).
PhotoHeader png_header(std::ifstream& in, const Bytes& start) {
  PhotoHeader header{"PNG", big_endian(start.data() + 16, 4), big_endian(start.data() + 20, 4)};
  header.has_alpha = (start[25] & 4) != 0;
  in.seekg(8);
  for (int chunk = 0; chunk < 10000; ++chunk) {
    unsigned char head[8];
    if (!in.read(reinterpret_cast<char*>(head), 8) || std::memcmp(head + 4, "IDAT", 4) == 0) break;
    if (std::memcmp(head + 4, "acTL", 4) == 0) header.more_frames = true;
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
PhotoHeader jpeg_header(std::ifstream& in, const std::string& name) {
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

std::uint32_t little_endian(const unsigned char* p, int bytes) {
  std::uint32_t value = 0;
  for (int i = bytes - 1; i >= 0; --i) value = value << 8 | p[i];
  return value;
}

// A WebP begins with RIFF, a length, WEBP and the name of its first chunk. VP8X states the size of the canvas
// less 1, VP8L has 14 bits of it for each side less 1, and a key frame of VP8 14 bits for each side.
PhotoHeader webp_header(const Bytes& start, const std::string& name) {
  const unsigned char* const p = start.data();
  if (std::memcmp(p + 12, "VP8X", 4) == 0) {
    if ((p[20] & 2) != 0) throw InputError(name + ": an animated WebP; save one frame of it as PNG");
    return {"WebP", little_endian(p + 24, 3) + 1, little_endian(p + 27, 3) + 1, false, (p[20] & 16) != 0};
  }
  if (std::memcmp(p + 12, "VP8L", 4) == 0 && p[20] == 0x2f) {
    const std::uint32_t bits = little_endian(p + 21, 4);
    return {"WebP", (bits & 0x3fff) + 1, (bits >> 14 & 0x3fff) + 1, false, (bits >> 28 & 1) != 0};
  }
  if (std::memcmp(p + 12, "VP8 ", 4) == 0)
    return {"WebP", little_endian(p + 26, 2) & 0x3fff, little_endian(p + 28, 2) & 0x3fff};
  throw InputError(name + ": WebP without a picture; the file is damaged, save it again");
}

}  // namespace

std::optional<PhotoHeader> read_photo_header(const std::filesystem::path& file) {
  require_plain_file(file);
  const std::string name = file.string();
  std::ifstream in(file, std::ios::binary);
  if (!in) throw InputError(name + ": cannot be read; check its rights");
  Bytes start{};
  in.read(reinterpret_cast<char*>(start.data()), start.size());
  in.clear();
  if (std::memcmp(start.data(), "\x89PNG\r\n\x1a\n", 8) == 0) return png_header(in, start);
  if (std::memcmp(start.data(), "\xff\xd8\xff", 3) == 0) return jpeg_header(in, name);
  if (std::memcmp(start.data(), "RIFF", 4) == 0 && std::memcmp(start.data() + 8, "WEBP", 4) == 0)
    return webp_header(start, name);
  return {};
}

}  // namespace astrolith
