// Labelled meshes as folders hold them.
#pragma once

#include <filesystem>
#include <span>
#include <string>
#include <vector>

namespace astrolith {

struct LabelledFiles {
  std::vector<std::string> classes;          // names of folders, sorted
  std::vector<std::filesystem::path> files;  // of each class in turn, sorted by name
  std::vector<int> labels;                   // (#files) indices into classes
};

// True for the extensions of mesh formats (obj, ply, stl, off, tab, plt, icq, bmf), in either case.
bool has_mesh_extension(const std::filesystem::path& file);

// A folder with folders in it: each of these is a class, named as the folder is. A folder without: it is one
// class. Files without a mesh's extension and hidden ones are passed over; folders of the same name are one
// class. Throws InputError for what is no folder, for meshes beside class folders (are they a class or not?)
// and for a class without meshes.
LabelledFiles find_classes(std::span<const std::filesystem::path> folders);

// The meshes in a folder, not in those within, sorted by name.
std::vector<std::filesystem::path> meshes_in(const std::filesystem::path& folder);

}  // namespace astrolith
