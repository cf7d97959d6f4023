// Lists of points in text files.
#include "fuzzed_reader.h"
#include "geometry/io/mesh_io.h"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace astrolith;
  const fuzz::FileInMemory file(data, size);
  fuzz::run_reader(size, {1 << 20, 100}, [&] { read_points(file.path()); });
  return 0;
}
