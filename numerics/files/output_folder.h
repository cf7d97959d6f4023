// Folders for outputs of several files that are made only once there is something to write.
#pragma once

#include <unistd.h>

#include <filesystem>
#include <system_error>

#include "numerics/errors.h"

namespace astrolith {

// To be called before long work. Throws InputError when the folder is not there and could not be made now.
inline void require_folder_can_be_made(const std::filesystem::path& folder) {
  std::error_code error;
  std::filesystem::path there = std::filesystem::absolute(folder, error).lexically_normal();
  while (!std::filesystem::exists(there, error) && there.has_relative_path()) there = there.parent_path();
  if (!std::filesystem::is_directory(there, error) || ::access(there.c_str(), W_OK) != 0) {
    throw InputError(folder.string() + ": cannot make this folder; choose a place that is writable");
  }
}

}  // namespace astrolith
