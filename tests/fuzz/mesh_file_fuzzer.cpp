// Mesh files of any format, as programs read them: the content tells the format, and indices and coordinates
// are checked.
#include <cmath>

#include "fuzzed_reader.h"
#include "geometry/io/mesh_io.h"

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
  fuzz::run_reader(size, {1 << 20, 200}, [&] { check_mesh(read_mesh_or_points(file.path())); });
  return 0;
}
