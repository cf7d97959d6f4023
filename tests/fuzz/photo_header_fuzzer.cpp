// Sizes of photos and rasters, read without decoding.
#include "estimation/gabor/image/image_reader.h"
#include "fuzzed_reader.h"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace astrolith;
  const fuzz::FileInMemory file(data, size);
  fuzz::run_reader(size, {4 << 20, 20}, [&] { read_image_size(file.path()); });
  return 0;
}
