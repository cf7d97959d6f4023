// The library of measured bodies: recipes that are installed with the programs (library/ in the source).
#pragma once

#include <filesystem>
#include <string>
#include <vector>

namespace astrolith {

// The names of the library's bodies in alphabetical order: "eros" for eros.astro. Empty where no library is
// found. The library is the folder that the environment's ASTROLITH_LIBRARY names. Without it, it is the
// folder share/astrolith/library beside or above the folder of this code, a program or a Python module.
std::vector<std::string> library_bodies();

// The file of a recipe or mesh that a person names: `name` itself, or, for a word without folder and
// extension that is no file, the body of the library with this name, in small or capital letters, or the
// population of this name in its folder populations, such as asteroids. Throws
// MissingFileError for such a word that no body has; the message says which one was probably meant.
std::filesystem::path find_body(const std::filesystem::path& name);

// What the help of an option says of find_body().
inline const std::string kOrLibraryBody =
    ", or the name of a body of the library, such as eros; asteroids "
    "is its population, of which bodies that nobody has seen are drawn";

}  // namespace astrolith
