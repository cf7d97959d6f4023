// Recipes in JSON. What was read must be written and read again to the same text.
#include <string_view>

#include "fuzzed_reader.h"
#include "recipe/recipe_json.h"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace astrolith;
  const std::string_view text(reinterpret_cast<const char*>(data), size);
  fuzz::run_reader(size, {4 << 20, 2000}, [&] {
    const std::string written = recipe_to_json(parse_recipe(text, "fuzzed"));
    if (recipe_to_json(parse_recipe(written, "written")) != written) std::abort();
  });
  return 0;
}
