// Photos and rasters, decoded by GDAL: pixels, gaps, units and places on the ground. A few bytes may state
// many pixels, so that only small images are decoded.
#include "estimation/gabor/image/image_reader.h"
#include "fuzzed_reader.h"

namespace {

void read(const std::uint8_t* data, std::size_t size, astrolith::fuzz::MemoryBound bound) {
  constexpr double kMostPixels = 1 << 16;
  const astrolith::fuzz::FileInMemory file(data, size);
  astrolith::fuzz::run_reader(size, bound, [&] {
    const astrolith::ImageSize image = astrolith::read_image_size(file.path());
    if (1.0 * image.width * image.height <= kMostPixels) astrolith::read_image(file.path(), true);
  });
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  // GDAL makes its tables for the first file.
  static constexpr std::uint8_t kNoImage[] = {'n', 'o', 'n', 'e'};
  static const bool ready = (read(kNoImage, sizeof kNoImage, {64 << 20, 0}), true);
  // Arrays of a TIFF's strips as for image_size, and GDAL's cache of blocks beside 2^16 pixels of three
  // colours.
  if (ready) read(data, size, {256 << 20, 20});
  return 0;
}
