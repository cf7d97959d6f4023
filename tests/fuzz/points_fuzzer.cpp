// Lists of points in text files.
#include "fuzzed_reader.h"
#include "geometry/io/mesh_io.h"
#include "numerics/files/zstd_stream.h"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace astrolith;
  const fuzz::FileInMemory file(data, size);
  // A compressed file is unpacked to at most 100 times its size.
  const bool packed = is_zstd({reinterpret_cast<const char*>(data), size});
  fuzz::run_reader(size, {1 << 20, packed ? 5000 : 100}, [&] { read_points(file.path()); });
  return 0;
}
