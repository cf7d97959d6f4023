#include "tasks/job/body_library.h"

#include <dlfcn.h>
#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cctype>
#include <cstdlib>
#include <system_error>

#include "numerics/edit_distance.h"
#include "numerics/files/input_file.h"
#include "recipe/recipe_json.h"

namespace astrolith {
namespace {

namespace fs = std::filesystem;

// The file that holds this code: a program, or a module of the Python package.
fs::path find_code_file() {
  std::error_code none;
  const fs::path program = fs::read_symlink("/proc/self/exe", none);
  static const char kInThisCode = 0;
  Dl_info info{};
  if (::dladdr(&kInThisCode, &info) == 0 || info.dli_fname == nullptr) return program;
  // The file of a program is stated as the shell called it. A module has a name that ends in .so.
  const fs::path file = info.dli_fname;
  return file.extension() == ".so" ? fs::canonical(file, none) : program;
}

// Empty where there is none.
fs::path library_folder() {
  if (const char* const stated = std::getenv("ASTROLITH_LIBRARY")) return stated;
  constexpr int kMostSteps = 3;  // from a test or a Python module to the root of the build
  fs::path place = find_code_file().parent_path();
  std::error_code none;
  for (int step = 0; step < kMostSteps; ++step, place = place.parent_path()) {
    const fs::path folder = place / "share/astrolith/library";
    if (fs::is_directory(folder, none)) return folder;
  }
  return {};
}

bool is_plain_word(const fs::path& name) {
  return !name.empty() && !name.has_parent_path() && !name.has_extension() && name != "." && name != "..";
}

}  // namespace

std::vector<std::string> library_bodies() {
  std::vector<std::string> names;
  std::error_code none;
  for (const fs::directory_entry& entry : fs::directory_iterator(library_folder(), none)) {
    if (is_compact_name(entry.path())) names.push_back(entry.path().stem().string());
  }
  std::sort(names.begin(), names.end());
  return names;
}

fs::path find_body(const fs::path& name) {
  std::error_code none;
  const bool exists = fs::exists(name, none);
  if (!is_plain_word(name) || (exists && !fs::is_directory(name, none))) return name;
  const std::vector<std::string> bodies = library_bodies();
  std::string word = name.string();
  for (char& letter : word) letter = static_cast<char>(std::tolower(static_cast<unsigned char>(letter)));
  if (std::binary_search(bodies.begin(), bodies.end(), word))
    return library_folder() / (word + std::string(kCompactExtension));
  const fs::path population = library_folder() / "populations" / (word + std::string(kCompactExtension));
  if (fs::is_regular_file(population, none)) return population;
  if (exists || bodies.empty()) return name;  // whoever opens it says that it is a folder, or missing
  std::vector<std::string> words = bodies;
  words.emplace_back("asteroids");
  const std::string nearest = nearest_name(word, words);
  throw MissingFileError(name.string() + ": is no file and no body of the library; " +
                         (nearest.empty() ? fmt::format("it has {}", fmt::join(bodies, ", "))
                                          : "did you mean " + nearest + "?"));
}

}  // namespace astrolith
