// Writes a trained classifier into a file and reads it: everything that predictions need.
#pragma once

#include <filesystem>
#include <string>

#include "descriptor/classification/shape_classifier.h"

namespace astrolith {

// Writes JSON, which YAML readers read too. The same classifier and tool give the same bytes. Throws
// InputError when the file cannot be written or would be larger than 128 MiB.
void write_classifier(const ShapeClassifier& classifier, const std::string& tool,
                      const std::filesystem::path& file);

// Reads a classifier and checks every index and size, so that a classifier that was read can be used. Throws
// InputError ("FILE: place: what is wrong; what to do") for anything that write_classifier does not write,
// and for files of more than 128 MiB.
ShapeClassifier read_classifier(const std::filesystem::path& file);

}  // namespace astrolith
