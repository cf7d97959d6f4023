// Finds labelled meshes in folders, where the name of a folder is the label of its meshes, and computes the
// feature vectors of many mesh files. Files that cannot be used are named, and the work goes on.
#pragma once

#include <filesystem>
#include <functional>
#include <span>
#include <string>
#include <vector>

#include "descriptor/classification/shape_classifier.h"
#include "numerics/progress.h"

namespace astrolith {

struct LabelledFiles {
  std::vector<std::string> classes;            // names of the folders, sorted
  std::vector<std::filesystem::path> files;    // the files of each class in turn, sorted by name
  std::vector<int> labels;                     // (#files) indices into classes
  std::vector<std::filesystem::path> skipped;  // files without the ending of a mesh, hidden ones left out
};

// If a folder contains folders, each of these is a class with the name of the inner folder. A folder without
// inner folders is one class. Hidden files are ignored, and files without the extension of a mesh are listed
// as skipped. Folders of the same name are one class. Throws InputError for anything that is no folder, for
// meshes beside class folders (they might be a class or not), and for a class without meshes.
LabelledFiles find_classes(std::span<const std::filesystem::path> folders);

// The meshes in a folder itself, without those in inner folders, sorted by name.
std::vector<std::filesystem::path> meshes_in(const std::filesystem::path& folder);

// The files in a folder itself that have no extension of a mesh and are not hidden, sorted by name.
std::vector<std::filesystem::path> others_in(const std::filesystem::path& folder);

struct FeatureTable {
  FeatureRows rows;                   // (#files); empty where the file could not be used
  std::vector<std::string> failures;  // one line for each such file, with its name
  std::vector<std::string> remarks;   // one line for each file that is used and was mended, or is open
};

// Reads a file, several at once; what there is to say of it goes into `remark`. Throws InputError.
using ShapeReader = std::function<TriangleMesh(const std::filesystem::path& file, std::string& remark)>;

// Reads the files in parallel; the result does not depend on the number of threads. Throws InputError for
// options out of range, and WorkError when progress asks to stop.
FeatureTable read_features(std::span<const std::filesystem::path> files, const FeatureOptions& options,
                           const ShapeReader& read, const Progress& progress = {});

// The rows that are not empty, with their labels.
LabelledFeatures labelled(const LabelledFiles& files, const FeatureTable& table);

}  // namespace astrolith
