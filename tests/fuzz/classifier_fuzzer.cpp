// Files of trained classifiers.
#include "descriptor/classification/classifier_file.h"
#include "fuzzed_reader.h"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace astrolith;
  const fuzz::FileInMemory file(data, size);
  fuzz::run_reader(size, {4 << 20, 500}, [&] { read_classifier(file.path()); });
  return 0;
}
