// Compact recipes. The fuzzer makes what follows the header, and the check in the header is made right, since
// it would refuse nearly every file.
#include "fuzzed_reader.h"
#include "recipe/recipe_json.h"

namespace {

// CRC-16 with the polynomial 0x1021, as docs/recipe_compact.md states for compact recipes.
unsigned checksum(const std::uint8_t* data, std::size_t size) {
  unsigned check = 0xffff;
  for (std::size_t i = 0; i < size; ++i) {
    check ^= static_cast<unsigned>(data[i]) << 8;
    for (int bit = 0; bit < 8; ++bit)
      check = ((check << 1) ^ ((check & 0x8000) != 0 ? 0x1021u : 0u)) & 0xffff;
  }
  return check;
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace astrolith;
  const unsigned check = checksum(data, size);
  std::string file = "AST\1";
  file += static_cast<char>(check >> 8);
  file += static_cast<char>(check & 0xff);
  file.append(reinterpret_cast<const char*>(data), size);
  fuzz::run_reader(size, {32 << 20, 10000}, [&] { parse_recipe(file, "fuzzed"); });
  return 0;
}
