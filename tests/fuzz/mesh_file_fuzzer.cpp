// Mesh files of any format, as programs read them: the stated unit, then the mesh. The content tells the
// format, and indices and coordinates are checked.
#include <cmath>

#include "fuzzed_reader.h"
#include "geometry/io/mesh_io.h"
#include "numerics/files/zstd_stream.h"

namespace {

void check_mesh(const astrolith::TriangleMesh& mesh) {
  for (const auto& triangle : mesh.triangles) {
    for (const auto index : triangle) {
      if (static_cast<std::size_t>(index) >= mesh.vertices.size()) std::abort();
    }
  }
  for (const auto& v : mesh.vertices) {
    if (!std::isfinite(v.x) || !std::isfinite(v.y) || !std::isfinite(v.z)) std::abort();
  }
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace astrolith;
  const fuzz::FileInMemory file(data, size);
  // A compressed file is unpacked to at most 100 times its size, with a window of at most 8 MB.
  const bool packed = is_zstd({reinterpret_cast<const char*>(data), size});
  const fuzz::MemoryBound bound =
      packed ? fuzz::MemoryBound{16 << 20, 20500} : fuzz::MemoryBound{1 << 20, 200};
  fuzz::run_reader(size, bound, [&] {
    stated_length_unit(file.path());  // unpacks the start of a compressed file
    check_mesh(read_mesh_or_points(file.path()));
  });
  return 0;
}
