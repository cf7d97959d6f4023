// Turns recipes into compact ones and back, and compares: the JSON text must be equal. Prints the bytes of
// both forms. tests/benchmarks/random_recipes.py --only-write makes recipes for it.
//
//   compact_recipe_benchmark RECIPE...
#include <fmt/format.h>

#include "numerics/errors.h"
#include "recipe/recipe_json.h"

int main(int argc, char** argv) {
  using namespace astrolith;
  std::size_t json_bytes = 0, compact_bytes = 0, equal = 0, refused = 0;
  for (int i = 1; i < argc; ++i) {
    std::string text;
    try {
      text = recipe_to_json(read_recipe(argv[i]));
    } catch (const InputError&) {
      ++refused;
      continue;
    }
    const std::string compact = recipe_to_compact(parse_recipe(text, argv[i]));
    json_bytes += text.size();
    compact_bytes += compact.size();
    if (recipe_to_json(parse_recipe(compact, argv[i])) == text) {
      ++equal;
    } else {
      fmt::print("{}: differs\n", argv[i]);
    }
  }
  const auto read = static_cast<std::size_t>(argc - 1) - refused;
  fmt::print("{} recipes read, {} refused, {} equal; {} bytes of JSON, {} bytes compact\n", read, refused,
             equal, json_bytes, compact_bytes);
  return equal == read ? 0 : 1;
}
