#include "synthesis/picture/png_reader.h"

#include <png.h>

#include <algorithm>
#include <bit>
#include <csetjmp>
#include <cstring>
#include <utility>

#include "numerics/errors.h"
#include "numerics/srgb.h"

namespace astrolith {
namespace {

// The bytes of a file, and how many of them libpng has taken.
struct PngBytes {
  const std::uint8_t* data;
  std::size_t size, taken;
};

void take_bytes(png_structp png, png_bytep out, png_size_t size) {
  auto* bytes = static_cast<PngBytes*>(png_get_io_ptr(png));
  if (size > bytes->size - bytes->taken) png_error(png, "the file ends early");
  std::memcpy(out, bytes->data + bytes->taken, size);
  bytes->taken += size;
}

void ignore_warning(png_structp, png_const_charp) {}
[[noreturn]] void leave_reader(png_structp png, png_const_charp) { png_longjmp(png, 1); }

struct PngSize {
  int width, height;
};

// libpng reports errors by longjmp, so that no object in the functions below may need a destructor. Memory
// belongs to the caller.
bool read_size(png_structp png, png_infop info, PngBytes* bytes, PngSize* size) {
  if (setjmp(png_jmpbuf(png)) != 0) return false;
  png_set_read_fn(png, bytes, take_bytes);
  png_read_info(png, info);
  size->width = static_cast<int>(png_get_image_width(png, info));
  size->height = static_cast<int>(png_get_image_height(png, info));
  return true;
}

// Reads all pixels as 16-bit channels of grey, or of red, green and blue. Returns the number of channels, or
// 0 for a damaged file. `channels` gets room for three channels of each pixel by the caller.
int read_pixels(png_structp png, png_infop info, const PngSize& size, std::uint16_t* channels,
                png_bytep* rows) {
  if (setjmp(png_jmpbuf(png)) != 0) return 0;
  png_set_expand(png);
  png_set_expand_16(png);
  png_set_strip_alpha(png);
  if (std::endian::native == std::endian::little) png_set_swap(png);
  png_set_interlace_handling(png);
  png_read_update_info(png, info);
  const int count = png_get_channels(png, info);
  if ((count != 1 && count != 3) || png_get_bit_depth(png, info) != 16) return 0;
  for (int y = 0; y < size.height; ++y) {
    rows[y] = reinterpret_cast<png_bytep>(channels + static_cast<std::size_t>(y) *
                                                         static_cast<std::size_t>(size.width) *
                                                         static_cast<std::size_t>(count));
  }
  png_read_image(png, rows);
  png_read_end(png, nullptr);
  return count;
}

// A reader of libpng that is released at the end of its scope.
struct PngReader {
  png_structp png = png_create_read_struct(PNG_LIBPNG_VER_STRING, nullptr, leave_reader, ignore_warning);
  png_infop info = png != nullptr ? png_create_info_struct(png) : nullptr;

  PngReader() = default;
  PngReader(const PngReader&) = delete;
  PngReader& operator=(const PngReader&) = delete;
  ~PngReader() { png_destroy_read_struct(&png, &info, nullptr); }
};

std::vector<std::uint16_t> grey_of(const std::vector<std::uint16_t>& channels, int count,
                                   std::size_t pixels) {
  std::vector<std::uint16_t> grey(pixels);
  for (std::size_t i = 0; i < pixels; ++i) {
    if (count == 1) {
      grey[i] = channels[i];
    } else {
      grey[i] = luma_of(channels[3 * i], channels[3 * i + 1], channels[3 * i + 2]);
    }
  }
  return grey;
}

}  // namespace

GreyPng decode_grey_png(const std::vector<std::uint8_t>& bytes, const std::string& file, int least_side,
                        int most_side) {
  constexpr std::size_t kSignature = 8;
  if (bytes.size() < kSignature || png_sig_cmp(bytes.data(), 0, kSignature) != 0) {
    throw InputError(file + ": is no PNG; convert it, or let fit_gabor --model exemplar write one");
  }
  PngReader reader;
  PngBytes source{bytes.data(), bytes.size(), 0};
  PngSize size{};
  const std::string damaged = file + ": is damaged, or no PNG that libpng reads; write it again";
  if (reader.info == nullptr || !read_size(reader.png, reader.info, &source, &size))
    throw InputError(damaged);
  const auto [least, most] = std::minmax(size.width, size.height);
  if (least < least_side || most > most_side) {
    throw InputError(file + ": is " + std::to_string(size.width) + " x " + std::to_string(size.height) +
                     " pixels; cut out or scale it to sides of " + std::to_string(least_side) + " to " +
                     std::to_string(most_side));
  }
  const std::size_t pixels = static_cast<std::size_t>(size.width) * static_cast<std::size_t>(size.height);
  std::vector<std::uint16_t> channels(3 * pixels);
  std::vector<png_bytep> rows(static_cast<std::size_t>(size.height));
  const int count = read_pixels(reader.png, reader.info, size, channels.data(), rows.data());
  if (count == 0) throw InputError(damaged);
  std::vector<std::uint16_t> grey = grey_of(channels, count, pixels);
  if (count == 1) channels.clear();
  return {size.width, size.height, std::move(grey), std::move(channels)};
}

}  // namespace astrolith
