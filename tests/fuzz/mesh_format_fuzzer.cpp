// One format of mesh files: compiled once for each reader, whose name is ASTROLITH_READER.
#include "fuzzed_reader.h"
#include "geometry/io/format_internal.h"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace astrolith;
  if (size == 0) return 0;  // load_mesh_file refuses empty files
  const MeshFile file{"fuzzed", std::string(reinterpret_cast<const char*>(data), size)};
  fuzz::run_reader(size, {1 << 20, 200}, [&] { ASTROLITH_READER(file); });
  return 0;
}
