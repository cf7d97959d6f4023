// PNG files as images of exemplar layers. A decoded image takes memory by its sides, which are bounded before
// decoding: a small side keeps the fuzzer quick.
#include <vector>

#include "fuzzed_reader.h"
#include "synthesis/picture/image_file.h"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace astrolith;
  const std::vector<std::uint8_t> bytes(data, data + size);
  fuzz::run_reader(size, {4 << 20, 20}, [&] { decode_grey_png(bytes, "fuzzed", 1, 128); });
  return 0;
}
