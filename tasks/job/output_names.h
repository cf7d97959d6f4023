// Checks of the names of output files.
#pragma once

#include <filesystem>
#include <initializer_list>
#include <string>

#include "numerics/errors.h"

namespace astrolith {

// Throws InputError when the file has none of the extensions.
inline void require_extension(const std::filesystem::path& file,
                              std::initializer_list<const char*> extensions) {
  std::string wanted;
  for (const char* extension : extensions) {
    if (file.string().ends_with(extension)) return;
    wanted += (wanted.empty() ? "" : " or ") + std::string(extension);
  }
  throw InputError(file.string() + ": is no " + wanted + " file; name it with that extension");
}

}  // namespace astrolith
