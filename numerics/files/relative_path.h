// Names of files in files, such as the image that a recipe names.
#pragma once

#include <filesystem>
#include <string>

namespace astrolith {

// The name of `file` as it reads in `reader`: relative to the folder of the latter. Symbolic links on the way
// to both are followed, because the system leads `..` to the folder that holds the folder itself, and not the
// link. A last name that is a link stays.
inline std::string relative_to(const std::filesystem::path& reader, const std::filesystem::path& file) {
  const auto folder_of = [](const std::filesystem::path& name) {
    return std::filesystem::weakly_canonical(std::filesystem::absolute(name).parent_path());
  };
  return (folder_of(file) / file.filename()).lexically_relative(folder_of(reader)).generic_string();
}

}  // namespace astrolith
