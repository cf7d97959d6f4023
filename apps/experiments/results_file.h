// The figures of an experiment, as a plot reads them.
#pragma once

#include <filesystem>
#include <nlohmann/json.hpp>
#include <string>

#include "numerics/files/output_file.h"

namespace astrolith {

// Throws InputError when the file cannot be written, WorkError when the disk is full.
inline void write_results(const nlohmann::ordered_json& results, const std::filesystem::path& file_name) {
  OutputFile file(file_name);
  const std::string text = results.dump(1) + "\n";
  file.write(text.data(), text.size());
  file.commit();
}

}  // namespace astrolith
