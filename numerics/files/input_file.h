// Checks of an input file that every reader makes before it opens the file.
#pragma once

#include <filesystem>
#include <string>
#include <system_error>

#include "numerics/errors.h"

namespace astrolith {

// A file that is to be read does not exist.
class MissingFileError : public InputError {
 public:
  using InputError::InputError;
};

// Throws MissingFileError when the file is missing, and InputError when it is empty, a folder, or not a plain
// file. Opening a pipe could wait for ever, so pipes are refused. `place` is what the message begins with.
inline void require_plain_file(const std::filesystem::path& file, const std::string& place = {}) {
  std::error_code error;
  const std::filesystem::file_status status = std::filesystem::status(file, error);
  const std::string name = place + file.string();
  if (status.type() == std::filesystem::file_type::not_found) {
    throw MissingFileError(name + ": cannot be read (No such file or directory); check the name");
  }
  if (!std::filesystem::exists(status)) {
    throw InputError(name + ": cannot be read (" + error.message() + "); check the name");
  }
  if (std::filesystem::is_directory(status))
    throw InputError(name + ": is a folder; give the name of a file");
  if (!std::filesystem::is_regular_file(status)) {
    throw InputError(name + ": is not a plain file; copy it into a file first");
  }
  if (std::filesystem::file_size(file, error) == 0) throw InputError(name + ": is empty; give another file");
}

}  // namespace astrolith
