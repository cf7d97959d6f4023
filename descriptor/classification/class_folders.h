// Finds labelled meshes in folders: the name of a folder is the label of its meshes.
#pragma once

#include <filesystem>
#include <span>
#include <string>
#include <vector>

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

}  // namespace astrolith
