// Computes the feature vectors of many mesh files. Files that cannot be used are named, and the work goes on.
#pragma once

#include <filesystem>
#include <functional>
#include <span>
#include <string>
#include <vector>

#include "descriptor/classification/class_folders.h"
#include "descriptor/classification/shape_classifier.h"
#include "numerics/progress.h"

namespace astrolith {

struct FeatureTable {
  FeatureRows rows;                   // (#files); empty where the file could not be used
  std::vector<std::string> failures;  // one line for each such file, with its name
  std::vector<std::string> remarks;   // one line for each file that is used and was mended, or is open
};

// Reads a file, several at once; what there is to say of it goes into `remark`. Throws InputError.
using ShapeReader = std::function<TriangleMesh(const std::filesystem::path& file, std::string& remark)>;

// Reads the files in parallel; the result does not depend on the number of threads. Throws InputError for
// options out of range, and WorkError when progress asks to stop.
FeatureTable features_of_files(std::span<const std::filesystem::path> files, const FeatureOptions& options,
                               const ShapeReader& read, const Progress& progress = {});

// The rows that are not empty, with their labels.
LabelledFeatures labelled(const LabelledFiles& files, const FeatureTable& table);

}  // namespace astrolith
