// A trained classifier in a file: everything that predicting needs.
#pragma once

#include <filesystem>
#include <string>

#include "descriptor/classification/shape_classifier.h"

namespace astrolith {

// JSON, which YAML readers read too. The same classifier and tool give the same bytes. Throws InputError when
// the file cannot be written or would be larger than 128 MiB.
void write_classifier(const ShapeClassifier& classifier, const std::string& tool,
                      const std::filesystem::path& file);

// Every index and size is checked, so that a classifier which was read can be used. Throws InputError ("FILE:
// place: what is wrong; what to do") for anything that write_classifier does not write, and for files of more
// than 128 MiB.
ShapeClassifier read_classifier(const std::filesystem::path& file);

}  // namespace astrolith
