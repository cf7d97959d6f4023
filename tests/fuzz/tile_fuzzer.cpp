// What check_tiles reads: the certificate of a tile, and its mesh. The content tells which.

#include "fuzzed_reader.h"
#include "geometry/io/ply_stream_reader.h"
#include "synthesis/mesh/manifold_check.h"
#include "tasks/synth/tile_certificate.h"

namespace {

void read_tile_mesh(const std::filesystem::path& file) {
  astrolith::ManifoldCheck check;
  astrolith::TileBorder border(-0.5f, 0.5f);
  astrolith::SinkList sinks;
  sinks.add(check);
  sinks.add(border);
  astrolith::PlyStreamReader(file).read(sinks);
  check.finish();
  border.figures();
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace astrolith;
  const fuzz::FileInMemory file(data, size);
  const bool is_mesh = size > 0 && data[0] == 'p';
  fuzz::run_reader(size, {4 << 20, 500}, [&] {
    if (is_mesh) {
      read_tile_mesh(file.path());
    } else {
      read_tile_certificate(file.path());
    }
  });
  return 0;
}
