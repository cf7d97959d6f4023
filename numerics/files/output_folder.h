// Output folders that are made only when there is something to write into them.
#pragma once

#include <unistd.h>

#include <filesystem>
#include <system_error>

#include "numerics/errors.h"

namespace astrolith {

// Throws InputError when the folder neither exists nor could be made now. Programs call it before long work.
inline void require_folder_can_be_made(const std::filesystem::path& folder) {
  std::error_code error;
  std::filesystem::path there = std::filesystem::absolute(folder, error).lexically_normal();
  while (!std::filesystem::exists(there, error) && there.has_relative_path()) there = there.parent_path();
  if (!std::filesystem::is_directory(there, error) || ::access(there.c_str(), W_OK) != 0) {
    throw InputError(folder.string() + ": cannot make this folder; choose a place that is writable");
  }
}

}  // namespace astrolith
