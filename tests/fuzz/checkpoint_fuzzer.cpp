// Checkpoints of fit_shape.
#include "fuzzed_reader.h"
#include "tasks/estimation/fit_checkpoint.h"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace astrolith;
  const fuzz::FileInMemory file(data, size);
  fuzz::run_reader(size, {4 << 20, 500}, [&] { FitCheckpoint(file.path(), {"fuzzed 1", "none", "0", {}}); });
  return 0;
}
