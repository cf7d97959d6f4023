// Sizes of photos and rasters, read without decoding.
#include "estimation/gabor/image/image_reader.h"
#include "fuzzed_reader.h"

namespace {

void read_size(const std::uint8_t* data, std::size_t size, astrolith::fuzz::MemoryBound bound) {
  const astrolith::fuzz::FileInMemory file(data, size);
  astrolith::fuzz::run_reader(size, bound, [&] { astrolith::read_image_size(file.path()); });
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  // GDAL makes its tables for the first file.
  static constexpr std::uint8_t kNoImage[] = {'n', 'o', 'n', 'e'};
  static const bool ready = (read_size(kNoImage, sizeof kNoImage, {64 << 20, 0}), true);
  // A TIFF that declares more strips than it lists gets arrays of up to a million of them.
  if (ready) read_size(data, size, {48 << 20, 20});
  return 0;
}
